// Net forces of one chunk of blocks. Its nodes belong to no other chunk, so nothing is shared and nothing races.
#pragma once

#include "libcdem/step/workspace.hpp"

namespace cdem {

// Clear, elements, springs, loads: Workspace::force of the chunk's nodes. spring_forces and mesh_forces have run
// before.
void net_forces(const Model&, const State&, Workspace&, const BlockChunk&);

} // namespace cdem
