// What a model is asked that it can do but that hardly anybody means. Each is told once.
#include "libcdem/simulation_impl.hpp"

#include "libcdem/load/resolve.hpp"
#include "libcdem/load/water_table.hpp"
#include "libcdem/results/fields.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace cdem {
namespace {

constexpr double least_slope = 0.1; // z of the normal of ground that looks up
constexpr double tellable = 0.01;   // share of a load that a support takes

// The share of a load along an axis that held nodes take, over its nodes.
double held_share(const std::map<int, Node>& free, const std::vector<int>& nodes, int axis) {
  std::size_t held = 0;
  for (const int node : nodes)
    if (const auto at = free.find(node); at != free.end() && vec(at->second)[axis] == 0)
      ++held;
  return nodes.empty() ? 0 : static_cast<double>(held) / static_cast<double>(nodes.size());
}

} // namespace

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
      const std::string line = fmt::format(
          "force on {}: its part along {} acts {} that a fix holds along {}: the support takes it, and "
          "nothing moves by it",
          force.on.text, "xyz"[axis],
          share == 1 ? std::string("on nodes") : fmt::format("with {:.2g} of its nodes on nodes", share),
          "xyz"[axis]);
      if (told.insert(line).second)
        observer->warning("warning: " + line);
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
      if (told.insert(line).second)
        observer->warning("warning: " + line);
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
  if (told.insert(line).second)
    observer->warning("warning: " + line);
}

// Ground below the water table that looks up is the bed of open water: the joints push its blocks up, and nothing but a
// traction of the water above pushes them down.
void Simulation::Impl::warn_of_open_water(const Water& water) {
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
  if (told.insert(line).second)
    observer->warning("warning: " + line);
}

} // namespace cdem
