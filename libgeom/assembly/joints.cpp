// Joint sets: families of planes by dip, dip direction and spacing, with seeded scatter.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/discs.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/core/stop.hpp"
#include "libgeom/polyhedron/cut.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace geom {
namespace {

constexpr double least_gap = 0.05;     // of the spacing; scatter brings no two planes nearer than this
constexpr double widest_draw = 5;      // standard deviations of dip and direction
constexpr double most_planes = 1e6;    // of one set
constexpr double longest_shift = 0.05; // to bring a whole plane clear of the vertices near it
constexpr std::array clearances{
    1e-2, 1e-3}; // tried in turn; both of the spacing or a block's size, if that is less

void require_angle(const std::string& field, double value, double high) {
  if (!(value >= 0 && value <= high * (1 + 1e-12))) {
    char degrees[32];
    std::snprintf(degrees, sizeof degrees, "%.10g", value * 180 / M_PI);
    throw InputError(field, degrees, "from 0 to " + text(std::round(high * 180 / M_PI)) + " degrees");
  }
}

void check(const JointSet& set) {
  require_angle("dip", set.dip, M_PI / 2);
  require_angle("dip_direction", set.dip_direction, 2 * M_PI);
  require_positive("spacing", set.spacing);
  if (!(set.spacing_scatter >= 0 && set.spacing_scatter < 0.5))
    throw InputError("spacing_scatter", text(set.spacing_scatter), ">= 0 and < 0.5 (of the spacing)");
  require_angle("dip_scatter", set.dip_scatter, M_PI / 4);
  require_angle("direction_scatter", set.direction_scatter, M_PI / 4);
}

// About how many blocks come out: each set cuts a block into 1 + width / spacing parts.
void check_count(const Assembly& assembly, const std::vector<JointSet>& sets) {
  double blocks = 0;
  for (const Polyhedron& block : assembly.blocks) {
    double parts = 1;
    for (const JointSet& set : sets) {
      const Vec3 normal = normal_of_dip(set.dip, set.dip_direction);
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const Vec3& x : block.vertices) {
        low = std::min(low, normal.dot(x));
        high = std::max(high, normal.dot(x));
      }
      parts *= 1 + (high - low) / set.spacing;
    }
    blocks += parts;
  }
  const auto closest = std::min_element(
      sets.begin(), sets.end(), [](const JointSet& a, const JointSet& b) { return a.spacing < b.spacing; });
  if (closest != sets.end())
    require_block_count("spacing", text(closest->spacing), blocks, "use a wider spacing or fewer blocks");
}

// The planes of one set, sorted along its mean normal. Without scatter they stand one spacing apart, counted
// from the lowest corner of the box along that normal; with scatter the first place is drawn too.
std::vector<Plane> planes_of(const JointSet& set, std::uint64_t id, std::uint64_t seed, const Box& box) {
  const Vec3 mean = normal_of_dip(set.dip, set.dip_direction), centre = box.centre();
  const bool scattered = set.spacing_scatter > 0 || set.dip_scatter > 0 || set.direction_scatter > 0;
  const double tilt = std::min(widest_draw * (set.dip_scatter + set.direction_scatter), M_PI / 3);
  const double half =
      tilt > 0 ? 0.5 * box.size().norm() / portable::cos(tilt) // a tilted plane leans in from outside
               : 0.5 * mean.cwiseAbs().dot(box.size());
  if (!(2 * half <= most_planes * set.spacing))
    throw InputError("spacing", text(set.spacing),
                     "such that there are at most a million planes in a set (this asks for "
                     "about " +
                         text(std::round(2 * half / set.spacing)) + ")",
                     "use a wider spacing");
  const std::uint64_t stream = id << 32; // of this set's planes
  std::vector<Plane> planes;
  double place = -half;
  if (scattered)
    place -= set.spacing * uniform(seed, stream, 0);
  for (std::uint64_t k = 1;; ++k) {
    const double limit = (1 - least_gap) / std::max(set.spacing_scatter, 1e-12);
    place += set.spacing * (1 + set.spacing_scatter * std::clamp(normal(seed, stream + k, 0), -limit, limit));
    if (place >= half)
      return planes;
    const auto draw = [&](std::uint64_t n) {
      return std::clamp(normal(seed, stream + k, n), -widest_draw, widest_draw);
    };
    const Vec3 own = scattered ? normal_of_dip(set.dip + set.dip_scatter * draw(1),
                                               set.dip_direction + set.direction_scatter * draw(2))
                               : mean;
    planes.push_back(Plane::through(centre + place * mean, own));
  }
}

// The plane shifted as a whole so that it keeps clear of all vertices near it, if a short shift can do that:
// then the cut runs straight on from block to block.
std::optional<Plane> shifted_as_a_whole(const Assembly& assembly, const Plane& plane, double clearance,
                                        double longest) {
  std::vector<double> levels;
  double largest = std::abs(plane.offset);
  for (const Polyhedron& block : assembly.blocks)
    for (const Vec3& x : block.vertices)
      if (const double level = plane.level(x); std::abs(level) <= longest + 2 * clearance) {
        levels.push_back(level);
        largest = std::max(largest, x.cwiseAbs().maxCoeff());
      }
  const double rounding = 2 * std::numeric_limits<double>::epsilon() * largest;
  const double shift = clear_shift(std::move(levels), clearance, rounding);
  if (std::abs(shift) > longest)
    return std::nullopt;
  return Plane{plane.normal, plane.offset + shift};
}

// scale: the spacing or a block's size, m.
Assembly cut_clear(Assembly assembly, const Plane& plane, double scale, const std::string& name) {
  PlaneCutOptions cut;
  cut.name = name;
  for (double clearance : clearances)
    if (const auto shifted = shifted_as_a_whole(assembly, plane, clearance * scale, longest_shift * scale))
      return cut_by_plane(std::move(assembly), *shifted, cut);
  cut.clearance = clearances.back() * scale; // block by block
  return cut_by_plane(std::move(assembly), plane, cut);
}

} // namespace

Vec3 normal_of_dip(double dip, double dip_direction) {
  return {portable::sin(dip) * portable::sin(dip_direction),
          portable::sin(dip) * portable::cos(dip_direction), portable::cos(dip)};
}

Assembly cut_by_joints(const Assembly& assembly, const std::vector<JointSet>& sets, std::uint64_t seed) {
  for (const JointSet& set : sets)
    check(set);
  check_count(assembly, sets);
  if (assembly.blocks.empty())
    return assembly;
  const Box box = bounding_box(assembly);
  double volume = 0;
  for (const Polyhedron& block : assembly.blocks)
    volume += mass_properties(block).volume;
  const double block_size = std::cbrt(volume / static_cast<double>(assembly.blocks.size()));
  Assembly result = assembly;
  for (std::size_t s = 0; s < sets.size(); ++s)
    for (const Plane& plane : planes_of(sets[s], s, seed, box)) {
      throw_if_stopped();
      result = cut_clear(std::move(result), plane, std::min(sets[s].spacing, block_size), sets[s].name);
    }
  return result;
}

} // namespace geom
