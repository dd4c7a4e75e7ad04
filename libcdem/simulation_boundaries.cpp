// Boundaries that let waves out, in place of supports; bolts; probes of forces and momenta.
#include "libcdem/load/free_field.hpp"
#include "libcdem/simulation_checks.hpp"
#include "libcdem/simulation_impl.hpp"
#include "libcdem/state/places.hpp"
#include "libcdem/step/forces.hpp"
#include "libcdem/step/support_forces.hpp"

#include <cmath>

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

} // namespace

void Simulation::Impl::add_boundary(const Selection& on, const std::function<void(Conditions&)>& add) {
  Conditions changed = conditions;
  const auto same = [&](const Fix& fix) { return selects_same(fix.on, on); };
  changed.fixes.erase(std::remove_if(changed.fixes.begin(), changed.fixes.end(), same), changed.fixes.end());
  add(changed);
  Conditions own;
  add(own);
  if (replaying) {
    conditions = std::move(changed);
    return;
  }
  require_places(model, own);
  State& state = changing();
  Workspace work(model, state, conditions);
  update_external(work.resolved, state.time, &state.velocity);
  const std::vector<Node> net = net_forces(model, state, work, threads);
  const ResolvedConditions after = resolve(model, state, changed);
  state.support_force.resize(model.node_position.size());
  keep_reactions(work, net, after, state.support_force);
  state.column_displacement.resize(column_levels(after));
  state.column_velocity.resize(column_levels(after));
  last_good = state;
  conditions = std::move(changed);
}

void Simulation::quiet(const Quiet& quiet) {
  require_finite("velocity", quiet.velocity);
  require_finite("stress", quiet.stress);
  impl_->add_boundary(quiet.on, [&](Conditions& c) {
    const auto same = [&](const Quiet& other) { return selects_same(other.on, quiet.on); };
    c.quiets.erase(std::remove_if(c.quiets.begin(), c.quiets.end(), same), c.quiets.end());
    c.quiets.push_back(quiet);
  });
}

void Simulation::free_field(const FreeField& field) {
  impl_->add_boundary(field.on, [&](Conditions& c) {
    const auto same = [&](const FreeField& other) { return selects_same(other.on, field.on); };
    if (std::none_of(c.free_fields.begin(), c.free_fields.end(), same))
      c.free_fields.push_back(field);
  });
}

void Simulation::bolt(const Bolt& bolt) {
  Impl& s = *impl_;
  if (!s.replaying) {
    State with = s.whole();
    set_bolt(s.model, with, bolt);
    s.changing() = std::move(with);
    s.last_good = s.kept;
  }
  s.end_of_run.reset();
  s.conditions.bolts.push_back(bolt);
}

std::vector<Simulation::BoltRow> Simulation::bolts() const {
  const Impl& s = *impl_;
  std::vector<BoltRow> rows;
  int number = 0;
  for (const ResolvedBolt& bolt : resolve_bolts(s.model, s.kept, s.conditions.bolts)) {
    const Bolt& given = s.conditions.bolts[static_cast<std::size_t>(number++)];
    const auto n = static_cast<int>(bolt.at.size());
    const BoltNode* const nodes = s.kept.bolts.data() + bolt.first;
    for (int i = 0; i < n; ++i) {
      BoltRow row;
      row.bolt = number;
      row.node = i + 1;
      row.place = given.from + (given.to - given.from) * i / (n - 1);
      const double next = i + 1 < n ? nodes[i].tension : 0, before = i > 0 ? nodes[i - 1].tension : 0;
      row.tension =
          i == 0 && given.plate ? -nodes[0].grout : (std::abs(before) > std::abs(next) ? before : next);
      row.grout = -nodes[i].grout;
      row.slip = given.plate && i == 0 ? 0 : nodes[i].slip;
      row.yielded = i + 1 < n ? nodes[i].stretch / (given.length() / given.segments) : 0;
      rows.push_back(row);
    }
  }
  return rows;
}

namespace {

void add_probes(RunLog& log, const std::string& name, const char* quantity, int body, const std::string& on) {
  for (const char* const axis : {"x", "y", "z"}) {
    const std::string column = name + "_" + axis;
    for (const Probe& probe : log.probes)
      if (probe.name == column)
        throw geom::InputError("name", "\"" + name + "\"", "one that gives new columns",
                               "the history has \"" + column + "\"");
  }
  for (const char* const axis : {"x", "y", "z"})
    log.probes.push_back(
        {name + "_" + axis, "", geom::Vec3::Zero(), std::string(quantity) + "." + axis, body, on});
}

} // namespace

void Simulation::record_reaction(const std::string& name, const std::string& on) {
  if (selected_nodes(impl_->model, place_of_support(impl_->model, on)).empty())
    throw geom::InputError("on", on, "a side of the model's box (\"x-\" .. \"z+\") or the name of a body");
  add_probes(impl_->log, name, "reaction", -1, on);
}

void Simulation::record_momentum(const std::string& name, const std::string& body) {
  add_probes(impl_->log, name, "momentum", body_number(body), body);
}

} // namespace cdem
