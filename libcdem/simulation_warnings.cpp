// What a model is asked that it can do but that hardly anybody means. Each is told once.
#include "libcdem/simulation_impl.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/load/resolve.hpp"
#include "libcdem/load/water_table.hpp"
#include "libcdem/results/fields.hpp"
#include "libcdem/results/tet_at_place.hpp"
#include "libcdem/state/places.hpp"
#include "libcdem/step/support_forces.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace cdem {
namespace {

constexpr double least_slope = 0.1;   // z of the normal of ground that looks up
constexpr double least_weight = 1e-9; // of a node in the value at a place; less is rounding
constexpr double tellable = 0.01;     // share of a load that a support takes

bool holds_still(const HeldNode& node) {
  const auto none = [](const Node& n) { return n.x == 0 && n.y == 0 && n.z == 0; };
  const Node& target = node.target;
  return none(node.free) && none(node.prescribed) && std::isnan(target.x) && std::isnan(target.y) &&
         std::isnan(target.z) && node.dashpot < 0 &&
         std::all_of(node.varying.begin(), node.varying.end(), [](int hold) { return hold < 0; });
}

// The share of a load along an axis that held nodes take, over its nodes.
double held_share(const std::map<int, Node>& free, const std::vector<int>& nodes, int axis) {
  std::size_t held = 0;
  for (const int node : nodes)
    if (const auto at = free.find(node); at != free.end() && vec(at->second)[axis] == 0)
      ++held;
  return nodes.empty() ? 0 : static_cast<double>(held) / static_cast<double>(nodes.size());
}

} // namespace

void Simulation::Impl::tell(const std::string& line) {
  if (!replaying && told.insert(line).second)
    observer->warning("warning: " + line);
}

void Simulation::check_stage() {
  impl_->warn_before_stage();
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
    if (const auto lowest = flow.water ? impl_->lowest_place(flow.on) : std::nullopt)
      ask(std::function<void(double)>([&](double time) { flow.water->at(*lowest, time); }));
  }
  for (const CrackPressure& pressure : c.crack_pressures) {
    ask(pressure.pressure);
    ask(pressure.volume);
  }
  if (c.gravity) {
    ask(c.gravity->amplitude);
    ask(c.gravity->turning);
  }
  impl_->look_for_dry_flows(begin, end);
}

void Simulation::Impl::warn_before_stage() {
  warn_of_loads_on_supports();
  warn_of_held_records();
  warn_of_unstressed_rock();
  warn_of_stress_jumps();
  for (const StillWater& water : conditions.still_waters)
    warn_of_open_water(water);
  for (const Flow& flow : conditions.flows)
    warn_of_uneven_bed(flow);
}

void Simulation::Impl::warn_of_loads_on_supports() {
  if (replaying || conditions.forces.empty())
    return;
  Conditions supports;
  supports.fixes = conditions.fixes;
  std::map<int, Node> free; // by node
  for (const HeldNode& node : resolve(model, whole(), supports).held)
    free.emplace(node.node, node.free);
  for (const PointForce& force : conditions.forces) {
    if (is_gone(model, force.on))
      continue;
    const std::vector<int> nodes = selected_nodes(model, force.on);
    for (int axis = 0; axis < 3; ++axis) {
      const double share = force.force[axis] == 0 ? 0 : held_share(free, nodes, axis);
      if (share < tellable)
        continue;
      tell(fmt::format(
          "force on {}: its part along {} acts {} that a fix holds along {}: the support takes it, and "
          "nothing moves by it",
          force.on.text, "xyz"[axis],
          share == 1 ? std::string("on nodes") : fmt::format("with {:.2g} of its nodes on nodes", share),
          "xyz"[axis]));
    }
  }
}

// What is recorded of rock that a fix holds still never changes; nor does the reaction where nothing is held.
void Simulation::Impl::warn_of_held_records() {
  if (replaying || (log.probes.empty() && log.watches.empty()))
    return;
  Conditions supports;
  supports.fixes = conditions.fixes;
  supports.quiets = conditions.quiets;
  supports.free_fields = conditions.free_fields;
  const std::vector<HeldNode> held = resolve(model, whole(), supports).held;
  std::vector<char> is_held(model.node_position.size(), 0), is_still = is_held;
  for (const HeldNode& node : held) {
    is_held[node.node] = 1;
    is_still[node.node] = holds_still(node);
  }
  const auto still = [&](int block) {
    const auto begin = is_still.begin();
    return std::all_of(begin + model.blocks[block].node_begin, begin + model.blocks[block].node_end,
                       [](char node) { return node != 0; });
  };
  const auto of_nodes = [](const std::string& field) {
    return field.rfind("displacement", 0) == 0 || field.rfind("velocity", 0) == 0;
  };
  const auto still_place = [&](const PlaceInTet& at) {
    for (std::size_t k = 0; k < 4; ++k)
      if (at.weight[k] > least_weight && is_still[model.tets[at.tet][k]] == 0)
        return false;
    return true;
  };
  for (const Watch& watch : log.watches)
    if (std::all_of(watch.blocks.begin(), watch.blocks.end(), still))
      tell(fmt::format(
          "watch of \"{}\": a fix holds all its units still, so that none can leave; watch another "
          "body, or release it",
          model.bodies[model.blocks[watch.blocks.front()].body].name));
  for (const Probe& probe : log.probes) {
    const std::string name =
        probe.name.substr(0, probe.name.size() - std::min<std::size_t>(2, probe.name.size()));
    if (probe.crack.empty()) {
      const auto at = tets_by_place(model)->find(model, probe.place);
      if (at && (of_nodes(probe.field) ? still_place(*at) : still(at->block)))
        tell(fmt::format("probe \"{}\": a fix holds the rock at ({:g}, {:g}, {:g}) m still: {} never changes "
                         "there; look at its place",
                         probe.name, probe.place.x(), probe.place.y(), probe.place.z(), probe.field));
    } else if (is_momentum(probe)) {
      bool moves = false;
      for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b)
        moves = moves || (model.blocks[b].body == probe.body && !still(b));
      if (!moves)
        tell(fmt::format("record_momentum \"{}\": a fix holds \"{}\" still: its momentum is 0", name,
                         probe.on));
    } else if (!probe.on.empty()) {
      const std::vector<int> nodes = selected_nodes(model, place_of_support(model, probe.on));
      const auto holds = [&](int node) {
        return is_held[node] != 0 ||
               (!kept.support_force.empty() && !vec(kept.support_force[node]).isZero(0));
      };
      if (std::none_of(nodes.begin(), nodes.end(), holds))
        tell(fmt::format("record_reaction \"{}\": nothing holds \"{}\": its reaction is 0", name, probe.on));
    }
  }
}

void Simulation::Impl::warn_of_lost_probes() {
  for (const Probe& probe : log.probes) {
    if (replaying || !probe.on.empty() || !probe.crack.empty())
      continue;
    if (!tets_by_place(model)->find(model, probe.place)) {
      const std::string line =
          fmt::format("probe \"{}\": the rock at ({:g}, {:g}, {:g}) m was removed; it is nan from now on",
                      probe.name, probe.place.x(), probe.place.y(), probe.place.z());
      tell(line);
    }
  }
}

// A relaxation takes no time, in which the forces of an excavation could fall.
void Simulation::Impl::warn_of_falling_forces() {
  if (replaying)
    return;
  double end = 0, share = 0;
  const double now = whole().time;
  for (const ExcavationForce& force : kept.excavation)
    if (force.end() > now) {
      end = std::max(end, force.end());
      share = std::max(share, force.share(now));
    }
  if (share == 0)
    return;
  const std::string line = fmt::format("relax: forces of an excavation fall until t = {:g} s, and a "
                                       "relaxation takes no time: it keeps them as "
                                       "they are now, up to {:.3g} of their full size; call model:run until "
                                       "then, or model:relax_excavation{{}}",
                                       end, share);
  tell(line);
}

// Rock above the surface where depth begins has no stress.
void Simulation::Impl::warn_of_dry_rock(const InitialStress& field) {
  if (replaying || !(field.gradient > 0) || !field.surface)
    return;
  geom::Box box;
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b)
    if (selects_block(model, field.on, b))
      for (int node = model.blocks[b].node_begin; node < model.blocks[b].node_end; ++node)
        box.extend(model.node_position[node]);
  if (*field.surface <= box.min.z())
    tell(fmt::format("initial_stress: surface = {:g} m lies below all rock of the place ({}), which reaches "
                     "from z = {:g} to "
                     "{:g} m: the gradient gives it no stress; surface is the z where depth begins",
                     *field.surface, field.on.text, box.min.z(), box.max.z()));
}

// Faces between rock with and without initial stress carry half of it (load/initial_stress.cpp): a place between layers that
// are given one by one was left out.
void Simulation::Impl::warn_of_unstressed_rock() {
  if (replaying || stage > 0 || model.interfaces.empty())
    return;
  const State& state = whole();
  std::vector<char> stressed(model.blocks.size(), 0);
  for (std::size_t b = 0; b < stressed.size(); ++b)
    for (int tet = model.blocks[b].tet_begin; tet < model.blocks[b].tet_end && stressed[b] == 0; ++tet) {
      const Stress s = model.blocks[b].meshed ? mesh_stress(model, state, tet) : state.initial_stress[tet];
      stressed[b] = std::any_of(s.begin(), s.end(), [](double component) { return component != 0; }) ? 1 : 0;
    }
  std::int64_t faces = 0;
  const Interface* first = nullptr;
  for (const Interface& interface : model.interfaces) {
    const Block &a = model.blocks[interface.block_a], &b = model.blocks[interface.block_b];
    if (a.body != b.body || stressed[interface.block_a] == stressed[interface.block_b])
      continue;
    ++faces;
    first = first ? first : &interface;
  }
  if (!first)
    return;
  const geom::Vec3& place = model.point_position[first->point_begin];
  tell(fmt::format(
      "initial_stress: {} of body \"{}\" {} between blocks with initial stress and blocks without, and {} "
      "half of it, such as at ({:.4g}, {:.4g}, {:.4g}) m; give one to the blocks on both sides",
      faces == 1 ? "1 face" : fmt::format("{} faces", faces),
      model.bodies[model.blocks[first->block_a].body].name, faces == 1 ? "lies" : "lie",
      faces == 1 ? "carries" : "carry", place.x(), place.y(), place.z()));
}

// Layers that are given their stress one by one are in balance only where both sides of their border have one traction.
void Simulation::Impl::warn_of_stress_jumps() {
  constexpr double alike = 0.05; // of the larger traction
  const auto given = std::exchange(given_stress, {});
  if (replaying || given.size() < 2 || given.back().has.size() != model.blocks.size())
    return;
  const double top = model.box.max.z();
  double largest = 0; // Pa
  std::string line;
  for (std::size_t p = 0; p < model.points.size(); ++p) {
    const Interface& interface = model.interfaces[model.points[p].interface];
    geom::Vec3 sides[2]; // tractions
    bool stressed[2] = {false, false};
    for (const int side : {0, 1}) {
      const int block = side == 0 ? interface.block_a : interface.block_b;
      sides[side].setZero();
      for (const GivenStress& one : given)
        if (one.has[block] != 0) {
          stressed[side] = true;
          sides[side] += matrix(stress_at(one.field, top, model.point_position[p])) * interface.normal;
        }
    }
    const double jump = (sides[0] - sides[1]).norm();
    if (!stressed[0] || !stressed[1] || !(jump > largest) ||
        !(jump > alike * std::max(sides[0].norm(), sides[1].norm())))
      continue;
    largest = jump;
    const auto body = [&](int block) { return model.bodies[model.blocks[block].body].name; };
    const geom::Vec3& x = model.point_position[p];
    line = fmt::format(
        "initial_stress: it jumps at a face between two layers, most at ({:.4g}, {:.4g}, {:.4g}) m: "
        "\"{}\" bears {:.4g} Pa there and \"{}\" {:.4g} Pa, so they will move; the lower layer "
        "needs the weight of the upper one too: stress = {{..., zz, ...}} beside its gradient",
        x.x(), x.y(), x.z(), body(interface.block_a), sides[0].norm(), body(interface.block_b),
        sides[1].norm());
  }
  if (!line.empty())
    tell(line);
}

// The blocks at this place that are in pieces and turn rigid.
void Simulation::Impl::warn_of_welded_pieces(const Selection& on) {
  if (replaying)
    return;
  const std::vector<int> pieces = fragments_of_nodes(model, whole());
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b) {
    const Block& block = model.blocks[b];
    if (!selects_block(model, on, b))
      continue;
    const std::set<int> of_block(pieces.begin() + block.node_begin, pieces.begin() + block.node_end);
    if (of_block.size() > 1)
      tell(
          fmt::format("make_rigid: block {} of body \"{}\" is broken into {} pieces, which move as one rigid "
                      "body from here on; make_deformable sets them free again",
                      block.id, model.bodies[block.body].name, of_block.size()));
  }
}

void Simulation::Impl::warn_of_distant_table(const std::shared_ptr<const WaterTable>& table) {
  if (replaying || !table)
    return;
  if (const std::string far = table->apart_from(model.box); !far.empty())
    tell("water_table: " + far);
}

std::optional<geom::Vec3> Simulation::Impl::lowest_place(const Selection& outer_faces) const {
  std::optional<geom::Vec3> lowest;
  for (const int face : selected_outer_faces(model, outer_faces))
    each_face_node(model, model.outer_faces[face], [&](int node, double) {
      if (const geom::Vec3& x = model.node_position[node]; !lowest || x.z() < lowest->z())
        lowest = x;
    });
  return lowest;
}

std::vector<std::string> Simulation::dry_flows() const {
  std::vector<std::string> lines;
  for (const Impl::DryFlow& dry : impl_->dry_flows)
    lines.push_back(dry.line);
  return lines;
}

// Water that wets no face at any of some times loads nothing. It may come later: whoever asks at the end knows.
void Simulation::Impl::look_for_dry_flows(double begin, double end) {
  constexpr int times = 20;
  constexpr std::size_t lowest = 200; // places that are asked all; others by strides
  if (replaying)
    return;
  for (const Flow& flow : conditions.flows) {
    const FlowKey key{flow.water.get(), flow.on.text};
    if (!flow.water || is_gone(model, flow.on) ||
        std::find(wet_flows.begin(), wet_flows.end(), key) != wet_flows.end())
      continue;
    std::vector<geom::Vec3> places;
    const auto add_faces = [&](const Selection& on) {
      for (const int face : selected_outer_faces(model, on))
        each_face_node(model, model.outer_faces[face], [&](int node, double) {
          places.push_back(place_of(model, whole(), node));
          places.push_back(model.node_position[node]);
        });
    };
    add_faces(flow.on);
    std::for_each(flow.also.begin(), flow.also.end(), add_faces);
    if (places.empty())
      continue;
    std::sort(places.begin(), places.end(),
              [](const geom::Vec3& a, const geom::Vec3& b) { return a.z() < b.z(); });
    const std::size_t stride = 1 + places.size() / lowest;
    double highest = -std::numeric_limits<double>::infinity();
    bool wet = false;
    for (int t = 0; t < times && !wet; ++t)
      for (std::size_t p = 0; p < places.size() && !wet; p += p < lowest ? 1 : stride) {
        const double surface = flow.water->at(places[p], begin + (end - begin) * t / times).surface;
        highest = std::max(highest, surface);
        wet = places[p].z() < surface;
      }
    const auto known =
        std::find_if(dry_flows.begin(), dry_flows.end(), [&](const DryFlow& dry) { return dry.flow == key; });
    const double first = known == dry_flows.end() ? begin : known->begin;
    if (known != dry_flows.end())
      dry_flows.erase(known);
    if (wet) {
      wet_flows.push_back(key);
      continue;
    }
    dry_flows.push_back({key, first,
                         fmt::format("flow on {}: its water reached no face from t = {:.3g} to {:.3g} s: {}, "
                                     "and the lowest face is at "
                                     "z = {:.3g} m; look at the level of the water",
                                     flow.on.text, first, end,
                                     std::isfinite(highest) ? fmt::format("it rose to z = {:.4g} m", highest)
                                                            : std::string("there was none at this place"),
                                     places.front().z())});
  }
}

// Ground below the water table that looks up is the bed of open water: the joints push its blocks up, and nothing but a
// traction of the water above pushes them down.
void Simulation::Impl::warn_of_open_water(const StillWater& water) {
  if (replaying || (!water.level && !water.table))
    return;
  const auto presses = [](const Traction& traction) { return traction.pressure.has_value(); };
  if (std::any_of(conditions.tractions.begin(), conditions.tractions.end(), presses))
    return;
  const auto depth = [&](const geom::Vec3& x) { // m, none where the table ends before
    return (water.level ? *water.level : water.table->height(x).value_or(x.z())) - x.z();
  };
  double area = 0, deepest = 0;
  for (const OuterFace& face : model.outer_faces) {
    if (face.normal.z() < least_slope)
      continue;
    double flooded = 0;
    each_face_node(model, face, [&](int node, double share) {
      const double here = depth(model.node_position[node]);
      if (here > model.tolerance) {
        flooded += share;
        deepest = std::max(deepest, here);
      }
    });
    area += flooded * face.normal.z();
  }
  if (!(area > 0))
    return;
  const std::string line = fmt::format(
      "water: {} stands above {:.3g} m2 of open ground, up to {:.3g} m: its pressure in the joints lifts "
      "that ground, and no traction of open water presses on it; lower the {} there (pressure = a function "
      "or "
      "a table), or add traction{{ on = the ground, {} }} for a lake",
      water.level ? fmt::format("level = {:g} m", *water.level) : "the water_table", area, deepest,
      water.level ? "level" : "table",
      water.level ? fmt::format("level = {:g}", *water.level) : "water_table = the same");
  tell(line);
}

// Ground is what the flow does not load. Waves made for a flat bed do not change over ground that rises from it: they
// neither steepen nor break.
void Simulation::Impl::warn_of_uneven_bed(const Flow& flow) {
  constexpr double alike = 0.05; // of the depth; and of the area of the ground
  const auto bed = flow.water ? flow.water->flat_bed() : std::nullopt;
  if (replaying || !bed)
    return;
  std::vector<char> is_loaded(model.bodies.size(), 0);
  const auto load = [&](const Selection& on) {
    for (const int face : selected_outer_faces(model, on))
      is_loaded[model.blocks[model.outer_faces[face].block].body] = 1;
  };
  load(flow.on);
  std::for_each(flow.also.begin(), flow.also.end(), load);
  double area = 0, uneven = 0, lowest = bed->level, highest = -std::numeric_limits<double>::infinity();
  for (const OuterFace& face : model.outer_faces)
    if (is_loaded[model.blocks[face.block].body] == 0 && face.normal.z() > least_slope)
      each_face_node(model, face, [&](int node, double share) {
        const double z = model.node_position[node].z(), level_share = share * face.normal.z();
        if (z > bed->level)
          return;
        area += level_share;
        if (std::abs(z - bed->z) > alike * (bed->level - bed->z))
          uneven += level_share;
        lowest = std::min(lowest, z);
        highest = std::max(highest, z);
      });
  if (uneven > alike * area)
    tell(fmt::format(
        "flow on {}: its waves keep their shape over a flat bed at z = {:.4g} m, but the ground under water "
        "lies between z = {:.4g} and {:.4g} m; cdem.water.slope computes waves that run up a slope, and the "
        "depth of a flat bed is level - z of the ground",
        flow.on.text, bed->z, lowest, highest));
}

} // namespace cdem
