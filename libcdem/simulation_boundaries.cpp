// Boundaries that let waves out, in place of supports.
#include "libcdem/load/free_field.hpp"
#include "libcdem/simulation_checks.hpp"
#include "libcdem/simulation_impl.hpp"
#include "libcdem/step/forces.hpp"

#include <algorithm>

namespace cdem {
namespace {

// The reactions of a fix go on where a boundary has taken its place.
void keep_reactions(const Workspace& work, const std::vector<Node>& net, const ResolvedConditions& after,
                    std::vector<Node>& support_force) {
  auto now = after.held.begin();
  for (const HeldNode& before : work.resolved.held) {
    while (now != after.held.end() && now->node < before.node)
      ++now;
    if (now == after.held.end() || now->node != before.node || now->dashpot < 0)
      continue;
    const auto take = [&](double was_free, double is_free, double force, double& support) {
      if (was_free == 0 && is_free != 0)
        support -= force;
    };
    Node& support = support_force[before.node];
    const Node& force = net[before.node];
    take(before.free.x, now->free.x, force.x, support.x);
    take(before.free.y, now->free.y, force.y, support.y);
    take(before.free.z, now->free.z, force.z, support.z);
  }
}

template <class Add>
void add_boundary(SimulatedModel& s, const Selection& on, const Add& add) {
  Conditions changed = s.conditions;
  const auto same = [&](const Fix& fix) { return selects_same(fix.on, on); };
  changed.fixes.erase(std::remove_if(changed.fixes.begin(), changed.fixes.end(), same), changed.fixes.end());
  add(changed);
  if (s.replaying) {
    s.conditions = std::move(changed);
    return;
  }
  State& state = s.changing();
  Workspace work(s.model, state, s.conditions);
  update_external(work.resolved, state.time, &state.velocity);
  const std::vector<Node> net = net_forces(s.model, state, work);
  const ResolvedConditions after = resolve(s.model, state, changed);
  state.support_force.resize(s.model.node_position.size());
  keep_reactions(work, net, after, state.support_force);
  state.column_displacement.resize(column_levels(after));
  state.column_velocity.resize(column_levels(after));
  s.last_good = state;
  s.conditions = std::move(changed);
}

} // namespace

void Simulation::quiet(const Quiet& quiet) {
  require_finite("velocity", quiet.velocity);
  require_finite("stress", quiet.stress);
  add_boundary(*impl_, quiet.on, [&](Conditions& c) {
    const auto same = [&](const Quiet& other) { return selects_same(other.on, quiet.on); };
    c.quiets.erase(std::remove_if(c.quiets.begin(), c.quiets.end(), same), c.quiets.end());
    c.quiets.push_back(quiet);
  });
}

void Simulation::free_field(const FreeField& field) {
  add_boundary(*impl_, field.on, [&](Conditions& c) {
    const auto same = [&](const FreeField& other) { return selects_same(other.on, field.on); };
    if (std::none_of(c.free_fields.begin(), c.free_fields.end(), same))
      c.free_fields.push_back(field);
  });
}

} // namespace cdem
