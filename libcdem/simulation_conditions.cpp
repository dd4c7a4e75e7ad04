// Conditions of a simulation: each is tried when it is given, so that a mistake is told of where it stands in the script.
#include "libcdem/load/flow.hpp"
#include "libcdem/load/free_field.hpp"
#include "libcdem/load/gone_body.hpp"
#include "libcdem/simulation_checks.hpp"
#include "libcdem/simulation_impl.hpp"
#include "libcdem/step/forces.hpp"
#include "libgeom/core/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

// Takes one more condition, tried first, so that one that selects nothing changes nothing. It is tried alone: the others
// were tried before, and thousands of calls take a time that grows with their number. Only what holds rigid bodies must
// fit together.
template <class Add>
void add_condition(SimulatedModel& s, const Add& add) {
  s.change_conditions();
  if (!s.replaying) {
    Conditions tried;
    if (!s.model.rigid.empty())
      tried.fixes = s.conditions.fixes;
    Conditions own;
    add(own);
    require_places(s.model, own);
    add(tried);
    resolve(s.model, s.whole(), tried);
  }
  add(s.conditions);
}

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
  Conditions own;
  add(own);
  require_places(s.model, own);
  State& state = s.changing();
  Workspace work(s.model, state, s.conditions);
  update_external(work.resolved, state.time, &state.velocity);
  const std::vector<Node> net = net_forces(s.model, state, work, s.threads);
  const ResolvedConditions after = resolve(s.model, state, changed);
  state.support_force.resize(s.model.node_position.size());
  keep_reactions(work, net, after, state.support_force);
  state.column_displacement.resize(column_levels(after));
  state.column_velocity.resize(column_levels(after));
  s.last_good = state;
  s.conditions = std::move(changed);
}

// Whether the last load acts where one before it does. chosen: the faces or nodes of a selection, ascending.
template <class Load>
bool meets_earlier(std::vector<int> (*chosen)(const Model&, const Selection&), const SimulatedModel& s,
                   const std::vector<Load>& loads) {
  if (s.replaying)
    return false;
  const std::vector<int> here = chosen(s.model, loads.back().on);
  return std::any_of(loads.begin(), loads.end() - 1, [&](const Load& earlier) {
    const std::vector<int> there = chosen(s.model, earlier.on);
    return std::any_of(there.begin(), there.end(),
                       [&](int place) { return std::binary_search(here.begin(), here.end(), place); });
  });
}

// The last flow pushes on a face that another pushes on too, as the faces stand undeformed.
bool flows_meet(const Model& model, const ResolvedConditions& r) {
  const auto meets = [&](const ResolvedFlow& flow, int f) { // a field may push from anywhere
    return flow.water || model.outer_faces[f].normal.dot(flow.direction) < 0;
  };
  const ResolvedFlow& last = r.flows.back();
  std::vector<char> met(model.outer_faces.size(), 0);
  for (std::size_t i = 0; i + 1 < r.flows.size(); ++i)
    for (const int f : r.flows[i].faces)
      met[f] = met[f] || meets(r.flows[i], f);
  return std::any_of(last.faces.begin(), last.faces.end(), [&](int f) { return met[f] && meets(last, f); });
}

// m, the lowest node of outer faces; none on none.
std::optional<geom::Vec3> lowest_place(const Model& model, const Flow& flow) {
  std::optional<geom::Vec3> lowest;
  for (const int face : flow_faces(model, flow))
    each_face_node(model, model.outer_faces[face], [&](int node, double) {
      if (const geom::Vec3& x = model.node_position[node]; !lowest || x.z() < lowest->z())
        lowest = x;
    });
  return lowest;
}

} // namespace

void Simulation::fix(const Fix& fix) {
  if (fix.displacement)
    require_finite("displacement", *fix.displacement);
  if (fix.velocity)
    require_finite("velocity", *fix.velocity);
  if (fix.displacement && fix.velocity)
    throw geom::InputError("displacement and velocity: give one of them");
  add_condition(*impl_, [&](Conditions& c) {
    add_fix(c.fixes, fix);
    const auto same = [&](const auto& boundary) { return selects_same(boundary.on, fix.on); };
    c.quiets.erase(std::remove_if(c.quiets.begin(), c.quiets.end(), same), c.quiets.end());
    c.free_fields.erase(std::remove_if(c.free_fields.begin(), c.free_fields.end(), same),
                        c.free_fields.end());
  });
}

void Simulation::release(const Selection& on, std::array<bool, 3> axes) {
  add_condition(*impl_, [&](Conditions& c) {
    Fix release;
    release.on = on;
    release.axes = axes;
    release.release = true;
    add_fix(c.fixes, release);
  });
}

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

bool Simulation::traction(const Traction& traction) {
  require_finite("stress", traction.stress);
  if (traction.pressure && traction.pressure->level) {
    geom::require(std::isfinite(*traction.pressure->level), "level", *traction.pressure->level,
                  "a finite height z (m)");
    geom::require_above("weight", traction.pressure->weight, 0, "N/m3", "water has 9810");
  }
  if (traction.pressure)
    impl_->warnings.of_distant_table(traction.pressure->table);
  add_condition(*impl_, [&](Conditions& c) { c.tractions.push_back(traction); });
  return meets_earlier(selected_outer_faces, *impl_, impl_->conditions.tractions);
}

bool Simulation::force(const PointForce& force) {
  require_finite("force", force.force);
  add_condition(*impl_, [&](Conditions& c) { c.forces.push_back(force); });
  return meets_earlier(selected_nodes, *impl_, impl_->conditions.forces);
}

void Simulation::gravity(const Gravity& gravity) {
  require_finite("vector", gravity.acceleration);
  geom::require_at_least("water_density", gravity.water_density, 0, "kg/m3");
  if (gravity.turning && gravity.amplitude)
    throw geom::InputError(
        "amplitude: goes with a constant vector; let the function that turns it scale it too");
  impl_->change_conditions();
  impl_->conditions.gravity = gravity;
}

bool Simulation::flow(const Flow& flow) {
  check(flow);
  impl_->change_conditions();
  Conditions changed = impl_->conditions;
  changed.flows.push_back(flow);
  if (impl_->replaying) {
    impl_->conditions = std::move(changed);
    return false;
  }
  Conditions own;
  own.flows.push_back(flow);
  require_places(impl_->model, own);
  const ResolvedConditions resolved = resolve(impl_->model, impl_->whole(), changed);
  if (resolved.flows.back().faces.empty())
    throw geom::InputError("on", flow.places(), "a place that a flow reaches",
                           "all its faces belong to cavities that a mesh closes");
  if (!flow.water && !flow.new_faces &&
      flow_pattern(impl_->model, impl_->whole(), resolved.flows.back()).empty())
    throw geom::InputError("direction", geom::shown(flow.direction),
                           "a direction that meets an outer face of the place (" + flow.places() + ")",
                           "a flow along x+ pushes on the side x-");
  if (flow.added_mass > 0)
    for (const BlockInWater& in_water : resolved.flows.back().in_water)
      if (const Block& block = impl_->model.blocks[in_water.asked.block]; !in_water.inertia)
        throw geom::InputError("added_mass", fmt::format("{:g}", flow.added_mass),
                               fmt::format("0 on a part of the faces of a unit of body \"{}\"",
                                           impl_->model.bodies[block.body].name),
                               "added mass belongs to the volume of a unit; name whole units");
  impl_->conditions = std::move(changed);
  return flows_meet(impl_->model, resolved);
}

void Simulation::crack_pressure(const CrackPressure& pressure) {
  if (pressure.volume)
    for (const auto& [field, value] :
         {std::pair{"bulk_modulus", pressure.bulk_modulus}, std::pair{"reservoir", pressure.reservoir}})
      geom::require_above(field, value, 0, "", "it goes with volume");
  if (!impl_->replaying)
    require_cracks(impl_->model, pressure.on);
  add_condition(*impl_, [&](Conditions& c) { c.crack_pressures.push_back(pressure); });
}

void Simulation::clear_loads() {
  impl_->change_conditions();
  impl_->conditions.crack_pressures.clear();
  impl_->conditions.flows.clear();
  impl_->conditions.tractions.clear();
  impl_->conditions.forces.clear();
  impl_->conditions.gravity.reset();
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

void Simulation::check_run(double begin, double end) {
  constexpr int times = 11;
  const Conditions& c = impl_->conditions;
  const auto ask = [&](const auto& function) {
    for (int t = 0; function && t < times; ++t)
      function(begin + (end - begin) * t / (times - 1));
  };
  for (const Fix& fix : c.fixes)
    ask(fix.amplitude);
  for (const Traction& traction : c.tractions)
    ask(traction.amplitude);
  for (const PointForce& force : c.forces)
    ask(force.amplitude);
  for (const Quiet& quiet : c.quiets)
    ask(quiet.amplitude);
  for (const Flow& flow : c.flows) {
    ask(flow.velocity);
    if (const auto lowest = flow.water ? lowest_place(impl_->model, flow) : std::nullopt)
      ask(std::function<void(double)>([&](double time) { flow.water->at(*lowest, time); }));
  }
  for (const CrackPressure& pressure : c.crack_pressures) {
    ask(pressure.pressure);
    ask(pressure.volume);
  }
  if (c.gravity) {
    ask(amplitude_of_gravity(impl_->model, c));
    ask(c.gravity->turning);
  }
  impl_->warnings.look_for_dry_flows(begin, end);
}

bool Simulation::anything_acts() const {
  const Conditions& c = impl_->conditions;
  if (c.load() || !c.quiets.empty() || !c.crack_pressures.empty())
    return true;
  const State& s = impl_->whole();
  if (!s.water_pressure.empty() || !s.excavation.empty())
    return true;
  const auto moves = [](const Fix& fix) { return fix.displacement || fix.velocity; };
  const auto is_nonzero = [](const Node& n) { return n.x != 0 || n.y != 0 || n.z != 0; };
  const auto is_strained = [](const StressBatch& batch) {
    for (const auto& component : batch.component)
      if (std::any_of(std::begin(component), std::end(component), [](double x) { return x != 0; }))
        return true;
    return false;
  };
  const auto is_tight = [](const BoltNode& bolt) { return bolt.grout != 0; };
  const auto is_stressed = [](const Stress& stress) {
    return std::any_of(stress.begin(), stress.end(), [](double x) { return x != 0; });
  };
  return std::any_of(c.fixes.begin(), c.fixes.end(), moves) ||
         std::any_of(s.bolts.begin(), s.bolts.end(), is_tight) ||
         std::any_of(s.displacement.begin(), s.displacement.end(), is_nonzero) ||
         std::any_of(s.velocity.begin(), s.velocity.end(), is_nonzero) ||
         std::any_of(s.initial_stress.begin(), s.initial_stress.end(), is_stressed) ||
         std::any_of(s.stress.begin(), s.stress.end(), is_strained);
}

} // namespace cdem
