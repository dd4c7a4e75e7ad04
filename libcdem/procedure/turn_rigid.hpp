// Meshed blocks that turn rigid and deformable again, between stages.
//
// Turning rigid keeps the shape of the moment, the stress in it, momentum and angular momentum; of the velocities what
// deforms the block is lost. Turning deformable gives every node v + w x r with the spin w that has the angular
// momentum, and turns the stress and the slip of broken faces with the block: R sigma R^T. Until then both stand in the
// directions of the moment the block was made rigid. What this does to the energy, kinetic energy of deformation above
// all, goes to EnergyLedger::fictitious, so that the balance stays closed.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// blocks: meshed ones, each once; those that are as asked already stay so. Returns how many changed.
std::int64_t set_rigid(Model&, State&, const std::vector<int>& blocks);
std::int64_t set_deformable(Model&, State&, const std::vector<int>& blocks);

// As the node stands with its rigid body: displacement, and velocity v + w x r.
void place_nodes(const Model&, State&, int rigid);

} // namespace cdem
