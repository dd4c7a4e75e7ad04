// Forces of one chunk of a mesh: its tets and its bonded faces, into its own slice of the partial forces. Chunks may
// run side by side.
#pragma once

#include "libcdem/step/workspace.hpp"

namespace cdem {

// Advances the stress by Workspace::strain_step, the step that the stress stands behind the nodes.
void mesh_forces(const Model&, State&, Workspace&, std::int64_t chunk, bool breaking);

// Workspace::position of the nodes from their displacements; nothing in a model without meshes.
void move_positions(const Model&, const State&, Workspace&, Range nodes);

} // namespace cdem
