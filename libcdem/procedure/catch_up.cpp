#include "libcdem/procedure/catch_up.hpp"

#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/integrate/move_columns.hpp"
#include "libcdem/integrate/move_held_nodes.hpp"
#include "libcdem/integrate/move_rigid.hpp"
#include "libcdem/integrate/viscous_forces.hpp"
#include "libcdem/procedure/turn_rigid.hpp"
#include "libcdem/state/places.hpp"
#include "libcdem/step/forces.hpp"
#include "libcdem/step/workspace.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// What is held keeps the velocity that it has: that of its support is due in the next step.
void keep_held_velocities(const State& state, ResolvedConditions& r) {
  for (HeldNode& held : r.held)
    held.prescribed = state.velocity[held.node];
  for (std::size_t i = 0; i < r.rigid.size(); ++i)
    if (r.rigid[i])
      r.rigid[i] = vec(state.rigid[i].velocity);
}

} // namespace

void catch_up_velocities(const Model& model, State& state, const Conditions& conditions) {
  if (state.velocity_lag == 0)
    return;
  const Stepping kick{0, state.velocity_lag}; // the places stay
  Workspace work(model, state, conditions);
  ResolvedConditions& r = work.resolved;
  keep_held_velocities(state, r);
  advance_columns(r, state, {state.time, kick.time_step, kick.kick});
  update_external(r, state.time, &state.velocity);
  const std::vector<Node> force = inner_forces(model, state, work, 1);
  const std::vector<double> viscous = viscous_forces(model);
  const auto nodes = [&](Range part) {
    MovingNodes moving =
        moving_nodes(state, work.acting(), moving_mass(model, state), part, &force[part.begin]);
    moving.viscous = viscous.empty() ? nullptr : &viscous[part.begin];
    return moving;
  };
  NodeSums sums;
  for (const Block& block : model.blocks) {
    if (block.rigid < 0) {
      step_nodes_and_held(r, {block.node_begin, block.node_end}, nodes, kick, sums);
    } else {
      move_rigid(model, state, work.acting(), block.rigid, kick, sums);
      place_nodes(model, state, block.rigid);
    }
  }
  state.velocity_lag = 0;
  EnergyLedger& spent = state.spent;
  spent.external += sums.external;
  spent.external_peak = std::max(spent.external_peak, std::abs(spent.external));
  spent.damping += sums.damping;
  spent.radiated += sums.radiated;
}

} // namespace cdem
