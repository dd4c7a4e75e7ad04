#include "libcdem/load/resolve.hpp"

#include "libcdem/element/small_strain.hpp"
#include "libcdem/load/excavation.hpp"
#include "libcdem/load/face_pressure.hpp"
#include "libcdem/load/flow.hpp"
#include "libcdem/load/free_field.hpp"
#include "libcdem/load/gone_body.hpp"
#include "libcdem/load/inner_shells.hpp"
#include "libcdem/load/units_in_water.hpp"
#include "libcdem/load/water_forces.hpp"
#include "libcdem/model/face_fan.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>

namespace cdem {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double& component(Node& node, int axis) {
  return axis == 0 ? node.x : axis == 1 ? node.y : node.z;
}

// Every node named by a fix, free or not.
using HeldNodes = std::map<int, HeldNode>;

HeldNode free_node(int node) {
  return {node, {1, 1, 1, 0}, {}, {nan, nan, nan, 0}};
}

void hold(const Model& model, const Fix& fix, HeldNodes& held, ResolvedConditions& r) {
  const std::vector<int> nodes = selected_nodes(model, fix.on);
  if (nodes.empty()) // removed since
    return;
  int varying = -1;
  if (fix.velocity && fix.amplitude && !fix.release) {
    varying = static_cast<int>(r.varying_holds.size());
    r.varying_holds.push_back({*fix.velocity, fix.amplitude, {}});
  }
  for (const int node : nodes) {
    HeldNode& h = held.try_emplace(node, free_node(node)).first->second;
    for (int axis = 0; axis < 3; ++axis) {
      if (!fix.axes[axis])
        continue;
      component(h.free, axis) = fix.release ? 1 : 0;
      h.varying[axis] = varying;
      component(h.prescribed, axis) = fix.velocity && !fix.release ? (*fix.velocity)[axis] : 0;
      component(h.target, axis) = fix.displacement && !fix.release ? (*fix.displacement)[axis] : nan;
      r.has_target = r.has_target || fix.displacement;
    }
  }
}

// What left the model far behind stays where it was then (step/escape.hpp).
void hold_escaped(const State& state, HeldNodes& held) {
  for (std::size_t i = 0; i < state.escaped.size(); ++i)
    if (state.escaped[i] == static_cast<std::uint8_t>(Escaped::held)) {
      const int node = static_cast<int>(i);
      held.insert_or_assign(node, HeldNode{node, {}, {}, {nan, nan, nan, 0}});
    }
}

bool is_held(const HeldNode& h) {
  return h.free.x == 0 || h.free.y == 0 || h.free.z == 0;
}

[[noreturn]] void cannot_hold(const Model& model, const Block& block, const char* how, const char* advice) {
  throw geom::InputError("fix: block " + std::to_string(block.id) + " of body \"" +
                         model.bodies[block.body].name + "\" is rigid and is held " + how + "; " + advice);
}

// The velocity that the held nodes of a rigid body give it; its other nodes are held with them.
std::optional<geom::Vec3> hold_rigid(const Model& model, const Block& block, int rigid, HeldNodes& held,
                                     ResolvedConditions& r) {
  const HeldNode* first = nullptr;
  for (auto h = held.lower_bound(block.node_begin); h != held.end() && h->first < block.node_end; ++h) {
    const HeldNode& node = h->second;
    if (!is_held(node))
      continue;
    if (node.free.x != 0 || node.free.y != 0 || node.free.z != 0)
      cannot_hold(model, block, "in some axes only", "hold it in xyz, or make it deformable");
    if (!std::isnan(node.target.x) || !std::isnan(node.target.y) || !std::isnan(node.target.z))
      cannot_hold(model, block, "at a given displacement",
                  "move it by a velocity in real-time stepping, or make it deformable");
    const Node& v = node.prescribed;
    if (!first)
      first = &node;
    else if (v.x != first->prescribed.x || v.y != first->prescribed.y || v.z != first->prescribed.z ||
             node.varying != first->varying || node.varying[0] != node.varying[1] ||
             node.varying[0] != node.varying[2])
      cannot_hold(model, block, "with several velocities", "give it one");
  }
  if (!first)
    return {};
  const Node v = first->prescribed;
  if (first->varying[0] >= 0)
    r.varying_holds[static_cast<std::size_t>(first->varying[0])].rigid.push_back(rigid);
  const std::array<int, 3> varying = first->varying;
  for (int node = block.node_begin; node < block.node_end; ++node)
    held.insert_or_assign(node, HeldNode{node, {}, v, {nan, nan, nan, 0}, varying});
  return geom::Vec3(v.x, v.y, v.z);
}

using Pattern = std::vector<std::pair<int, geom::Vec3>>;

Pattern traction_pattern(const Model& model, const Traction& traction) {
  const std::vector<int> faces = selected_outer_faces(model, traction.on);
  if (faces.empty()) // removed since
    return {};
  if (traction.pressure)
    return pressure_pattern(model, faces, *traction.pressure);
  Pattern pattern;
  for (const int f : faces)
    each_face_node(model, model.outer_faces[f],
                   [&](int node, double area) { pattern.emplace_back(node, area * traction.stress); });
  return pattern;
}

// Shared in proportion to the volume around each node, so that the nodes of blocks that meet in one place move
// together and a finer block does not attract more load.
Pattern force_pattern(const Model& model, const PointForce& force) {
  const std::vector<int> nodes = selected_nodes(model, force.on);
  double volume = 0;
  for (const int node : nodes)
    volume += node_volume(model, node);
  Pattern pattern;
  for (const int node : nodes)
    pattern.emplace_back(node, node_volume(model, node) / volume * force.force);
  return pattern;
}

Pattern gravity_pattern(const Model& model, const Gravity& gravity, const geom::Vec3& acceleration) {
  Pattern pattern;
  for (int node = 0; node < static_cast<int>(model.node_position.size()); ++node)
    pattern.emplace_back(node,
                         (model.gravitational_mass[node] - gravity.water_density * node_volume(model, node)) *
                             acceleration);
  return pattern;
}

void load(ResolvedConditions& r, Pattern&& pattern, const Amplitude& amplitude) {
  if (amplitude)
    r.varying.push_back({std::move(pattern), amplitude});
  else
    for (const auto& [node, force] : pattern)
      add(r.external[node], force);
}

// One that turns: a load along each axis.
void add_gravity(const Model& model, const Conditions& conditions, ResolvedConditions& r) {
  const Gravity& gravity = *conditions.gravity;
  if (!gravity.turning) {
    load(r, gravity_pattern(model, gravity, gravity.acceleration), amplitude_of_gravity(model, conditions));
    return;
  }
  for (int axis = 0; axis < 3; ++axis)
    load(r, gravity_pattern(model, gravity, geom::Vec3::Unit(axis)),
         [axis, turning = gravity.turning](double time) { return turning(time)[axis]; });
}

// Dashpots of quiet boundaries and free fields, and what enters through them.
void add_boundaries(const Model& model, const Conditions& conditions, HeldNodes& held,
                    ResolvedConditions& r) {
  Dashpots dashpots;
  for (const Quiet& quiet : conditions.quiets) {
    const std::vector<int> faces = add_dashpots(model, quiet.on, "quiet", dashpots);
    if (!quiet.velocity.isZero(0) || !quiet.stress.isZero(0)) {
      r.boundary_loads.push_back(r.varying.size());
      const Amplitude steady = [](double) { return 1; };
      r.varying.push_back({entering_wave(model, faces, quiet), quiet.amplitude ? quiet.amplitude : steady});
    }
  }
  for (const FreeField& field : conditions.free_fields) {
    const std::vector<int> faces = add_dashpots(model, field.on, "free_field", dashpots);
    Column column = free_field_column(model, conditions, field, faces);
    column.first = column_levels(r);
    column.load = r.varying.size();
    VaryingLoad side;
    for (const ColumnShare& share : column.shares)
      side.forces.emplace_back(share.node, geom::Vec3::Zero());
    side.amplitude = [](double) { return 1; };
    r.boundary_loads.push_back(r.varying.size());
    r.varying.push_back(std::move(side));
    r.columns.push_back(std::move(column));
  }
  for (const auto& [node, dashpot] : dashpots) {
    held.try_emplace(node, free_node(node)).first->second.dashpot = static_cast<int>(r.dashpots.size());
    r.dashpots.push_back(dashpot);
  }
}

// Blocks without an outer face are met where they are named: a joint beside one may open.
std::vector<Met> met_blocks(const Model& model, const Flow& flow, const std::vector<int>& faces) {
  std::vector<Met> met(model.blocks.size(), Met::nothing);
  for (const int face : faces)
    met[model.outer_faces[face].block] = Met::places;
  for (const Selection& on : flow.on) {
    using Kind = Selection::Kind;
    if (on.kind != Kind::all && on.kind != Kind::body && on.kind != Kind::units)
      continue;
    for (int b = 0; b < static_cast<int>(met.size()); ++b)
      if (selects_block(model, on, b))
        met[b] = Met::whole;
  }
  return met;
}

FaceFan fan_in_water(const Model& model, int block, std::vector<geom::Triangle>&& triangles) {
  FaceFan fan;
  fan.triangles = std::move(triangles);
  for (geom::Triangle& nodes : fan.triangles) {
    for (int& node : nodes)
      node += model.blocks[block].node_begin;
    const std::vector<geom::Vec3>& x = model.node_position;
    fan.area += 0.5 * (x[nodes[1]] - x[nodes[0]]).cross(x[nodes[2]] - x[nodes[0]]).norm();
  }
  return fan;
}

void add_flow(const Model& model, const Flow& flow, ResolvedConditions& r) {
  ResolvedFlow resolved;
  const std::vector<int> shells = of_inner_shells(model);
  resolved.faces = flow_faces(model, flow, shells);
  resolved.normals = smooth_normals(model, resolved.faces);
  resolved.new_faces = flow.new_faces;
  if (flow.new_faces)
    resolved.meets = met_blocks(model, flow, resolved.faces);
  resolved.load = r.varying.size();
  if (flow.water) {
    resolved.water = flow.water;
    resolved.water_density = flow.water->density();
    resolved.drag = flow.drag;
    resolved.added_mass = flow.added_mass;
    std::map<int, std::vector<int>> faces; // by block
    for (std::size_t i = 0; i < resolved.faces.size(); ++i)
      faces[model.outer_faces[resolved.faces[i]].block].push_back(static_cast<int>(i));
    for (int block = 0; block < static_cast<int>(model.blocks.size()); ++block)
      if (flow.new_faces && resolved.meets[block] != Met::nothing)
        faces[block];
    for (auto& [block, of_block] : faces) {
      BlockInWater& in_water = resolved.in_water.emplace_back();
      in_water.asked.block = block;
      in_water.asked.first_node = model.blocks[block].node_begin;
      for (std::vector<geom::Triangle>& triangles : fans_of(model, block))
        in_water.fans.push_back(fan_in_water(model, block, std::move(triangles)));
      for (const int i : of_block) {
        const OuterFace& face = model.outer_faces[resolved.faces[i]];
        in_water.face_corners += face.boundary >= 0 ? 3 : in_water.fans[face.face].corners(face);
      }
      in_water.faces = std::move(of_block);
    }
    find_units_in_water(model, shells, resolved);
    r.varying.push_back({{}, [](double) { return 1; }});
  } else if (flow.relative) {
    resolved.direction = flow.direction.normalized();
    resolved.velocity = flow.velocity;
    resolved.water_density = flow.water_density;
    r.varying.push_back({{}, [](double) { return 1; }});
  } else {
    resolved.direction = flow.direction.normalized();
    const double density = flow.water_density;
    const auto velocity = flow.velocity;
    r.varying.push_back(
        {{}, [density, velocity](double time) { return flow_pressure(velocity(time), density); }});
  }
  r.flows.push_back(std::move(resolved));
}

// Forces of a flow that meets each corner at u, the velocity of the water less that of the surface: rho/2 C_D (u . A)+ u, A
// the corner's share of a face, inward.
void add_relative_flow(const ResolvedFlow& flow, double time, const std::vector<Node>* velocity,
                       std::vector<std::pair<int, geom::Vec3>>& forces) {
  const geom::Vec3 water =
      flow.velocity ? geom::Vec3(flow.velocity(time) * flow.direction) : geom::Vec3::Zero();
  for (std::size_t i = 0; i < flow.corners.size(); ++i) {
    const FlowCorner& corner = flow.corners[i];
    geom::Vec3 u = flow.water ? corner.stream : water;
    if (velocity)
      u -= vec((*velocity)[corner.node]);
    forces[i].second = 0.5 * flow.drag * flow.water_density * std::max(0.0, u.dot(corner.inward)) * u;
  }
}

// Bodies and the water that carries them have one weight.
void require_one_gravity(const Conditions& conditions) {
  if (!conditions.gravity)
    return;
  const Gravity& gravity = *conditions.gravity;
  constexpr double rounded = 5e-3; // 9.8 for 9.81
  for (const Flow& flow : conditions.flows) {
    if (!flow.water || !flow.water->has_pressure())
      continue;
    if (gravity.water_density != 0)
      throw geom::InputError("gravity: water_density", fmt::format("{:g}", gravity.water_density),
                             "left out beside a flow whose water has a pressure",
                             "that pressure is the buoyancy already");
    const double g = flow.water->gravity();
    if (gravity.turning)
      throw geom::InputError(
          "gravity", "a function of time",
          fmt::format("the vector (0, 0, -{:g}) m/s2 beside a flow whose water has a pressure", g),
          "water stands level in z at all times");
    const geom::Vec3& given = gravity.acceleration;
    if ((given + g * geom::Vec3::UnitZ()).norm() > rounded * g)
      throw geom::InputError("gravity", geom::text(given),
                             fmt::format("(0, 0, -{:g}) m/s2, the gravity of the water of a flow", g),
                             "give the water the same `gravity`; water stands level in z");
  }
}

} // namespace

Amplitude amplitude_of_gravity(const Model& model, const Conditions& conditions) {
  const Amplitude& amplitude = conditions.gravity->amplitude;
  const bool floats = std::any_of(conditions.flows.begin(), conditions.flows.end(), [&](const Flow& flow) {
    return flow.water && flow.water->has_pressure() && !is_gone(model, flow);
  });
  if (!amplitude || !floats)
    return amplitude;
  return [amplitude](double time) {
    constexpr double rounded = 5e-3;
    const double part = amplitude(time);
    if (!(std::abs(part - 1) < rounded))
      throw geom::InputError(
          "gravity: amplitude", fmt::format("{:g} at t = {:g} s", part, time),
          "1 beside a flow whose water has a pressure",
          "the whole buoyancy would act on a part of the weight; let the water begin later");
    return part;
  };
}

void refresh_flows(const Model& model, const State& state, ResolvedConditions& r) {
  for (ResolvedFlow& flow : r.flows) {
    if (flow.water) {
      ask_water(model, state, flow);
      continue;
    }
    std::vector<std::pair<int, geom::Vec3>>& forces = r.varying[flow.load].forces;
    // What the pattern leaves keeps no force of it.
    for (const auto& [node, force] : forces)
      r.external[node] = r.constant[node];
    if (!flow.relative()) {
      forces = flow_pattern(model, state, flow);
      continue;
    }
    flow.corners = flow_corners(model, state, flow);
    forces.clear();
    for (const FlowCorner& corner : flow.corners)
      forces.emplace_back(corner.node, geom::Vec3::Zero());
  }
  place_water(model, state, {0, static_cast<std::int64_t>(model.node_position.size())}, 1, r);
}

ResolvedConditions resolve(const Model& model, const State& state, const Conditions& conditions) {
  require_one_gravity(conditions);
  ResolvedConditions r;
  const std::size_t n = model.node_position.size();
  HeldNodes held;
  if (conditions.load() || !conditions.bolts.empty() || !conditions.quiets.empty() ||
      !conditions.free_fields.empty() || !state.support_force.empty() || !state.excavation.empty())
    r.external.resize(n);
  std::copy(state.support_force.begin(), state.support_force.end(), r.external.begin());
  add_excavations(state, r);
  for (const Fix& fix : conditions.fixes)
    hold(model, fix, held, r);
  add_boundaries(model, conditions, held, r);
  hold_escaped(state, held);
  for (int i = 0; i < static_cast<int>(model.rigid.size()); ++i)
    r.rigid.push_back(hold_rigid(model, model.blocks[model.rigid[i].block], i, held, r));
  for (const auto& [node, h] : held)
    if (is_held(h) || h.dashpot >= 0)
      r.held.push_back(h);
  for (const Traction& traction : conditions.tractions)
    load(r, traction_pattern(model, traction), traction.amplitude);
  for (const PointForce& force : conditions.forces)
    load(r, force_pattern(model, force), force.amplitude);
  if (conditions.gravity)
    add_gravity(model, conditions, r);
  for (const Flow& flow : conditions.flows)
    if (!is_gone(model, flow))
      add_flow(model, flow, r);
  for (const CrackPressure& pressure : conditions.crack_pressures)
    if (!is_gone(model, pressure.on))
      r.cracks.push_back(resolve(model, state, pressure));
  if (!conditions.bolts.empty()) {
    r.bolts = resolve_bolts(model, state, conditions.bolts);
    r.bolt_load = r.varying.size();
    r.varying.push_back({{}, [](double) { return 1; }});
    bolt_forces(r.bolts, state, r.varying.back().forces);
  }
  if (!r.varying.empty())
    r.constant = r.external;
  refresh_flows(model, state, r);
  for (std::size_t tet = 0; tet < state.initial_stress.size(); ++tet)
    if (state.initial_stress[tet] != Stress{}) {
      r.internal.resize(n);
      add_stress_forces(model, static_cast<int>(tet), state.initial_stress[tet], r.internal);
    }
  return r;
}

void update_supports(ResolvedConditions& r, double time) {
  if (r.varying_holds.empty())
    return;
  std::vector<double> factors;
  for (const VaryingHold& hold : r.varying_holds) {
    factors.push_back(hold.amplitude(time));
    for (const int rigid : hold.rigid)
      r.rigid[rigid] = factors.back() * hold.velocity;
  }
  for (HeldNode& h : r.held)
    for (int axis = 0; axis < 3; ++axis)
      if (const int varying = h.varying[axis]; varying >= 0)
        component(h.prescribed, axis) = factors[varying] * r.varying_holds[varying].velocity[axis];
}

namespace {

// To the target of a component; NaN without one. What rounding left of a way is none: a support that is there stands.
double way_of(const Model& model, const State& state, const HeldNode& h, int axis) {
  const double target = vec(h.target)[axis], way = target - vec(state.displacement[h.node])[axis];
  return std::abs(way) <= 1e-15 * std::max(model.length, std::abs(target)) ? 0 : way;
}

} // namespace

void aim_supports(const Model& model, const State& state, ResolvedConditions& r, double left) {
  for (HeldNode& h : r.held)
    for (int axis = 0; axis < 3; ++axis)
      if (const double way = way_of(model, state, h, axis); !std::isnan(way))
        component(h.prescribed, axis) = way / left;
}

double longest_way(const Model& model, const State& state, const ResolvedConditions& r) {
  double longest2 = 0;
  for (const HeldNode& h : r.held) {
    double way2 = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (const double way = way_of(model, state, h, axis); !std::isnan(way))
        way2 += way * way;
    longest2 = std::max(longest2, way2);
  }
  return std::sqrt(longest2);
}

void update_external(ResolvedConditions& r, double time, const std::vector<Node>* velocity) {
  for (const ResolvedFlow& flow : r.flows)
    if (flow.relative())
      add_relative_flow(flow, time, velocity, r.varying[flow.load].forces);
  for (const VaryingLoad& load : r.varying)
    for (const auto& [node, force] : load.forces)
      r.external[node] = r.constant[node];
  for (const VaryingLoad& load : r.varying) {
    const double factor = load.amplitude(time);
    for (const auto& [node, force] : load.forces)
      add(r.external[node], factor * force);
  }
}

} // namespace cdem
