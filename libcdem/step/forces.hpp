// Net forces at nodes.
#pragma once

#include "libcdem/step/workspace.hpp"

namespace cdem {

// Of one chunk of star blocks: elements and springs, without loads, into Workspace::force. Its nodes belong to no other
// chunk, so nothing is shared and nothing races. spring_forces has run before.
void block_forces(const Model&, const State&, Workspace&, const BlockChunk&);

// N at every node, loads included, where the nodes are now (n_nodes); the workspace's loads are up to date.
std::vector<Node> net_forces(const Model&, const State&, Workspace&);

} // namespace cdem
