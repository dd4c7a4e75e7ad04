// Warnings of water: where flows reach no face, beds that waves do not know, open water that presses on nothing.
#include "libcdem/load/flow.hpp"
#include "libcdem/load/gone_body.hpp"
#include "libcdem/load/water_table.hpp"
#include "libcdem/simulation_warnings.hpp"
#include "libcdem/state/places.hpp"
#include "libcdem/water/water_over_bed.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace cdem {
namespace {

constexpr double least_slope = 0.1; // z of the normal of ground that looks up

} // namespace

void Warnings::of_distant_table(const std::shared_ptr<const WaterTable>& table) {
  if (of_.replaying || !table)
    return;
  if (const std::string far = table->apart_from(model_.box); !far.empty())
    tell("water_table: " + far);
}

std::vector<std::string> Warnings::dry_flows() const {
  std::vector<std::string> lines;
  for (const SeenFlow& seen : seen_flows_)
    if (!seen.line.empty())
      lines.push_back(seen.line);
  return lines;
}

// Water that wets no face at any of some times loads nothing. It may come later: whoever asks at the end knows.
void Warnings::look_for_dry_flows(double begin, double end) {
  constexpr int times = 20;
  constexpr std::size_t lowest = 200; // places that are asked all; others by strides
  if (of_.replaying)
    return;
  for (const Flow& flow : conditions_.flows) {
    const std::pair key(flow.water.get(), flow.places());
    const auto known = std::find_if(seen_flows_.begin(), seen_flows_.end(),
                                    [&](const SeenFlow& seen) { return seen.flow == key; });
    const bool is_known = known != seen_flows_.end();
    if (!flow.water || is_gone(model_, flow) || (is_known && known->line.empty()))
      continue;
    std::vector<geom::Vec3> places;
    for (const int face : flow_faces(model_, flow))
      each_face_node(model_, model_.outer_faces[face], [&](int node, double) {
        places.push_back(place_of(model_, of_.whole(), node));
        places.push_back(model_.node_position[node]);
      });
    if (places.empty())
      continue;
    std::sort(places.begin(), places.end(),
              [](const geom::Vec3& a, const geom::Vec3& b) { return a.z() < b.z(); });
    const std::size_t stride = 1 + places.size() / lowest;
    double highest = -std::numeric_limits<double>::infinity();
    bool wet = false;
    for (int t = 0; t < times && !wet; ++t)
      for (std::size_t p = 0; p < places.size() && !wet; p += p < lowest ? 1 : stride) {
        const double surface = seen_at(*flow.water, places[p], begin + (end - begin) * t / times).surface;
        highest = std::max(highest, surface);
        wet = places[p].z() < surface;
      }
    const double first = is_known ? known->begin : begin;
    if (is_known)
      seen_flows_.erase(known);
    seen_flows_.push_back({key, first, ""});
    if (!wet)
      seen_flows_.back().line =
          fmt::format("flow on {}: its water reached no face from t = {:.3g} to {:.3g} s: {}, "
                      "and the lowest face is at "
                      "z = {:.3g} m; look at the level of the water",
                      flow.places(), first, end,
                      std::isfinite(highest) ? fmt::format("it rose to z = {:.4g} m", highest)
                                             : std::string("there was none at this place"),
                      places.front().z());
  }
}

// Ground below the water table that looks up is the bed of open water: the joints push its blocks up, and nothing but a
// traction of the water above pushes them down.
void Warnings::of_open_water(const StillWater& water) {
  if (of_.replaying || (!water.level && !water.table))
    return;
  const auto presses = [](const Traction& traction) { return traction.pressure.has_value(); };
  if (std::any_of(conditions_.tractions.begin(), conditions_.tractions.end(), presses))
    return;
  const auto depth = [&](const geom::Vec3& x) { // m, none where the table ends before
    return (water.level ? *water.level : water.table->height(x).value_or(x.z())) - x.z();
  };
  double area = 0, deepest = 0;
  for (const OuterFace& face : model_.outer_faces) {
    if (face.normal.z() < least_slope)
      continue;
    double flooded = 0;
    each_face_node(model_, face, [&](int node, double share) {
      const double here = depth(model_.node_position[node]);
      if (here > model_.tolerance) {
        flooded += share;
        deepest = std::max(deepest, here);
      }
    });
    area += flooded * face.normal.z();
  }
  if (!(area > 0))
    return;
  tell(fmt::format(
      "water: {} stands above {:.3g} m2 of open ground, up to {:.3g} m: its pressure in the joints lifts "
      "that ground, and no traction of open water presses on it; lower the {} there (pressure = a function "
      "or "
      "a table), or add traction{{ on = the ground, {} }} for a lake",
      water.level ? fmt::format("level = {:g} m", *water.level) : "the water_table", area, deepest,
      water.level ? "level" : "table",
      water.level ? fmt::format("level = {:g}", *water.level) : "water_table = the same"));
}

// Ground is what the flow does not load. Waves made for a flat bed do not change over ground that rises from it: they
// neither steepen nor break.
void Warnings::of_uneven_bed(const Flow& flow) {
  constexpr double alike = 0.05; // of the depth; and of the area of the ground
  const auto bed = flow.water ? flow.water->flat_bed() : std::nullopt;
  if (!bed)
    return;
  std::vector<char> is_loaded(model_.bodies.size(), 0);
  for (const int face : flow_faces(model_, flow))
    is_loaded[model_.blocks[model_.outer_faces[face].block].body] = 1;
  double area = 0, uneven = 0, lowest = bed->level, highest = -std::numeric_limits<double>::infinity();
  for (const OuterFace& face : model_.outer_faces)
    if (is_loaded[model_.blocks[face.block].body] == 0 && face.normal.z() > least_slope)
      each_face_node(model_, face, [&](int node, double share) {
        const double z = model_.node_position[node].z(), level_share = share * face.normal.z();
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
        flow.places(), bed->z, lowest, highest));
}

} // namespace cdem
