// Water that moves with a body (load/water_forces.hpp).
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// kg, what moves with the nodes of a block beyond their own mass (State::moving_mass); of a rigid body, whose mass is the
// Model's.
inline double carried_mass(const Model& model, const State& state, const Block& block) {
  double mass = 0;
  if (!state.moving_mass.empty())
    for (int i = block.node_begin; i < block.node_end; ++i)
      mass += state.moving_mass[i] - model.node_mass[i];
  return mass;
}

} // namespace cdem
