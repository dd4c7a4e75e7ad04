// Makes meshed blocks rigid, and deformable again, between stages.
//
// A block that becomes rigid keeps its present shape, its stress, its momentum and its spin; the part of the velocities
// that deforms the block is lost. A block that becomes deformable gives every node v + w x r with the spin w of its
// angular momentum. R then turns its stress (R sigma R^T), the slip of its broken faces and the preload of its freed ones;
// until then they are stored in the directions in which the block was made rigid. The change of energy, mostly the kinetic
// energy of deformation, goes to EnergyLedger::fictitious, so that the balance stays closed.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// blocks: meshed ones, each once; those that are as asked already stay so. Returns how many changed.
std::int64_t set_rigid(Model&, State&, const std::vector<int>& blocks);
std::int64_t set_deformable(Model&, State&, const std::vector<int>& blocks);

// As the node stands with its rigid body: displacement, and velocity v + w x r.
void place_nodes(const Model&, State&, int rigid);

} // namespace cdem
