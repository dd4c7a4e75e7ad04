#include "libcdem/simulation_warnings.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/load/gone_body.hpp"
#include "libcdem/load/resolve.hpp"
#include "libcdem/results/fields.hpp"
#include "libcdem/results/tet_at_place.hpp"
#include "libcdem/state/places.hpp"
#include "libcdem/step/support_forces.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace cdem {
namespace {

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

void Warnings::tell(const std::string& line) {
  if (!of_.replaying && told_.insert(line).second)
    of_.observer->warning("warning: " + line);
}

void Warnings::before_stage() {
  if (of_.replaying)
    return;
  of_loads_on_supports();
  of_held_records();
  of_unstressed_rock();
  of_stress_jumps();
  for (const StillWater& water : conditions_.still_waters)
    of_open_water(water);
  for (const Flow& flow : conditions_.flows)
    of_uneven_bed(flow);
}

void Warnings::of_loads_on_supports() {
  if (conditions_.forces.empty())
    return;
  Conditions supports;
  supports.fixes = conditions_.fixes;
  std::map<int, Node> free; // by node
  for (const HeldNode& node : resolve(model_, of_.whole(), supports).held)
    free.emplace(node.node, node.free);
  for (const PointForce& force : conditions_.forces) {
    if (is_gone(model_, force.on))
      continue;
    const std::vector<int> nodes = selected_nodes(model_, force.on);
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
void Warnings::of_held_records() {
  if (log_.probes.empty() && log_.watches.empty())
    return;
  Conditions supports;
  supports.fixes = conditions_.fixes;
  supports.quiets = conditions_.quiets;
  supports.free_fields = conditions_.free_fields;
  const std::vector<HeldNode> held = resolve(model_, of_.whole(), supports).held;
  std::vector<char> is_held(model_.node_position.size(), 0), is_still = is_held;
  for (const HeldNode& node : held) {
    is_held[node.node] = 1;
    is_still[node.node] = holds_still(node);
  }
  const auto still = [&](int block) {
    const auto begin = is_still.begin();
    return std::all_of(begin + model_.blocks[block].node_begin, begin + model_.blocks[block].node_end,
                       [](char node) { return node != 0; });
  };
  const auto of_nodes = [](const std::string& field) {
    return field.rfind("displacement", 0) == 0 || field.rfind("velocity", 0) == 0;
  };
  const auto still_place = [&](const PlaceInTet& at) {
    for (std::size_t k = 0; k < 4; ++k)
      if (at.weight[k] > least_weight && is_still[model_.tets[at.tet][k]] == 0)
        return false;
    return true;
  };
  for (const Watch& watch : log_.watches)
    if (std::all_of(watch.blocks.begin(), watch.blocks.end(), still))
      tell(fmt::format(
          "watch of \"{}\": a fix holds all its units still, so that none can leave; watch another "
          "body, or release it",
          model_.bodies[model_.blocks[watch.blocks.front()].body].name));
  const std::shared_ptr<const TetsByPlace> tets = log_.probes.empty() ? nullptr : tets_by_place(model_);
  for (const Probe& probe : log_.probes) {
    const std::string name =
        probe.name.substr(0, probe.name.size() - std::min<std::size_t>(2, probe.name.size()));
    if (probe.crack.empty()) {
      const auto at = tets->find(model_, probe.place);
      if (at && (of_nodes(probe.field) ? still_place(*at) : still(at->block)))
        tell(fmt::format("probe \"{}\": a fix holds the rock at ({:g}, {:g}, {:g}) m still: {} never changes "
                         "there; look at its place",
                         probe.name, probe.place.x(), probe.place.y(), probe.place.z(), probe.field));
    } else if (is_momentum(probe)) {
      bool moves = false;
      for (int b = 0; b < static_cast<int>(model_.blocks.size()); ++b)
        moves = moves || (model_.blocks[b].body == probe.body && !still(b));
      if (!moves)
        tell(fmt::format("record_momentum \"{}\": a fix holds \"{}\" still: its momentum is 0", name,
                         probe.on));
    } else if (!probe.on.empty()) {
      const std::vector<int> nodes = selected_nodes(model_, place_of_support(model_, probe.on));
      const auto holds = [&](int node) {
        return is_held[node] != 0 ||
               (!of_.kept.support_force.empty() && !vec(of_.kept.support_force[node]).isZero(0));
      };
      if (std::none_of(nodes.begin(), nodes.end(), holds))
        tell(fmt::format("record_reaction \"{}\": nothing holds \"{}\": its reaction is 0", name, probe.on));
    }
  }
}

void Warnings::of_shared_place(const std::string& asks, const geom::Vec3& place) {
  if (of_.replaying)
    return;
  const std::shared_ptr<const TetsByPlace> tets = tets_by_place(model_);
  const auto at = tets->find(model_, place);
  if (!at)
    return;
  const int body = model_.blocks[at->block].body;
  if (const auto other = tets->find_beside(model_, place, body))
    tell(fmt::format("{}: ({:g}, {:g}, {:g}) m lies in two bodies, \"{}\" and \"{}\": the value is that of "
                     "\"{}\"; for the other, move the place a little into it",
                     asks, place.x(), place.y(), place.z(), model_.bodies[body].name,
                     model_.bodies[model_.blocks[other->block].body].name, model_.bodies[body].name));
}

void Warnings::of_lost_probes() {
  for (const Probe& probe : log_.probes)
    if (!of_.replaying && probe.on.empty() && probe.crack.empty() &&
        !tets_by_place(model_)->find(model_, probe.place))
      tell(fmt::format("probe \"{}\": the rock at ({:g}, {:g}, {:g}) m was removed; it is nan from now on",
                       probe.name, probe.place.x(), probe.place.y(), probe.place.z()));
}

// A relaxation takes no time, in which the forces of an excavation could fall.
void Warnings::of_falling_forces() {
  if (of_.replaying)
    return;
  double end = 0, share = 0;
  const double now = of_.whole().time;
  for (const ExcavationForce& force : of_.kept.excavation)
    if (force.end() > now) {
      end = std::max(end, force.end());
      share = std::max(share, force.share(now));
    }
  if (share == 0)
    return;
  tell(fmt::format("relax: forces of an excavation fall until t = {:g} s, and a "
                   "relaxation takes no time: it keeps them as "
                   "they are now, up to {:.3g} of their full size; call model:run until "
                   "then, or model:relax_excavation{{}}",
                   end, share));
}

void Warnings::of_initial_stress(const InitialStress& field) {
  if (of_.replaying)
    return;
  GivenStress given{field, {}};
  geom::Box box;
  for (int b = 0; b < static_cast<int>(model_.blocks.size()); ++b) {
    given.has.push_back(selects_block(model_, field.on, b) ? 1 : 0);
    for (int node = model_.blocks[b].node_begin; given.has[b] != 0 && node < model_.blocks[b].node_end;
         ++node)
      box.extend(model_.node_position[node]);
  }
  // Rock above the surface where depth begins has no stress.
  if (field.gradient > 0 && field.surface && *field.surface <= box.min.z())
    tell(fmt::format("initial_stress: surface = {:g} m lies below all rock of the place ({}), which reaches "
                     "from z = {:g} to "
                     "{:g} m: the gradient gives it no stress; surface is the z where depth begins",
                     *field.surface, field.on.text, box.min.z(), box.max.z()));
  if (of_.stage == 0)
    given_stress_.push_back(std::move(given));
}

// Faces between rock with and without initial stress carry half of it (load/initial_stress.cpp): a place between layers that
// are given one by one was left out.
void Warnings::of_unstressed_rock() {
  if (of_.stage > 0 || model_.interfaces.empty() || given_stress_.empty())
    return;
  const State& state = of_.whole();
  std::vector<char> stressed(model_.blocks.size(), 0);
  for (std::size_t b = 0; b < stressed.size(); ++b)
    for (int tet = model_.blocks[b].tet_begin; tet < model_.blocks[b].tet_end && stressed[b] == 0; ++tet) {
      const Stress s = model_.blocks[b].meshed ? mesh_stress(model_, state, tet) : state.initial_stress[tet];
      stressed[b] = std::any_of(s.begin(), s.end(), [](double component) { return component != 0; }) ? 1 : 0;
    }
  std::int64_t faces = 0;
  const Interface* first = nullptr;
  for (const Interface& interface : model_.interfaces) {
    const Block &a = model_.blocks[interface.block_a], &b = model_.blocks[interface.block_b];
    if (a.body != b.body || stressed[interface.block_a] == stressed[interface.block_b])
      continue;
    ++faces;
    first = first ? first : &interface;
  }
  if (!first)
    return;
  const geom::Vec3& place = model_.point_position[first->point_begin];
  tell(fmt::format(
      "initial_stress: {} of body \"{}\" {} between blocks with initial stress and blocks without, and {} "
      "half of it, such as at ({:.4g}, {:.4g}, {:.4g}) m; give one to the blocks on both sides",
      faces == 1 ? "1 face" : fmt::format("{} faces", faces),
      model_.bodies[model_.blocks[first->block_a].body].name, faces == 1 ? "lies" : "lie",
      faces == 1 ? "carries" : "carry", place.x(), place.y(), place.z()));
}

// Layers that are given their stress one by one are in balance only where both sides of their border have one traction.
void Warnings::of_joined_pieces(const Selection& turns_rigid) {
  if (of_.replaying)
    return;
  const std::vector<int> pieces = fragments_of_nodes(model_, of_.whole());
  for (int b = 0; b < static_cast<int>(model_.blocks.size()); ++b) {
    const Block& block = model_.blocks[b];
    if (!selects_block(model_, turns_rigid, b))
      continue;
    const std::set<int> of_block(pieces.begin() + block.node_begin, pieces.begin() + block.node_end);
    if (of_block.size() > 1)
      tell(
          fmt::format("make_rigid: block {} of body \"{}\" is broken into {} pieces, which move as one rigid "
                      "body from here on; make_deformable sets them free again",
                      block.id, model_.bodies[block.body].name, of_block.size()));
  }
}

void Warnings::of_stress_jumps() {
  constexpr double alike = 0.05; // of the larger traction
  const auto given = std::exchange(given_stress_, {});
  if (given.size() < 2 || given.back().has.size() != model_.blocks.size())
    return;
  const double top = model_.box.max.z();
  double largest = 0; // Pa
  std::string line;
  for (std::size_t p = 0; p < model_.points.size(); ++p) {
    const Interface& interface = model_.interfaces[model_.points[p].interface];
    geom::Vec3 sides[2]; // tractions
    bool stressed[2] = {false, false};
    for (const int side : {0, 1}) {
      const int block = side == 0 ? interface.block_a : interface.block_b;
      sides[side].setZero();
      for (const GivenStress& one : given)
        if (one.has[block] != 0) {
          stressed[side] = true;
          sides[side] += matrix(stress_at(one.field, top, model_.point_position[p])) * interface.normal;
        }
    }
    const double jump = (sides[0] - sides[1]).norm();
    if (!stressed[0] || !stressed[1] || !(jump > largest) ||
        !(jump > alike * std::max(sides[0].norm(), sides[1].norm())))
      continue;
    largest = jump;
    const auto body = [&](int block) { return model_.bodies[model_.blocks[block].body].name; };
    const geom::Vec3& x = model_.point_position[p];
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

} // namespace cdem
