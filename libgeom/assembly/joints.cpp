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
#include <climits>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>

namespace geom {
namespace {

constexpr double least_gap = 0.05;     // of the spacing; scatter brings no two planes nearer than this
constexpr double widest_draw = 5;      // standard deviations of dip and direction
constexpr double most_planes = 1e6;    // of one set
constexpr double longest_shift = 0.05; // to bring a whole plane clear of the vertices near it
constexpr std::uint64_t bridges_id = std::uint64_t{1} << 62; // random numbers of their own
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
  if (set.origin)
    require_finite("origin", *set.origin);
  if (set.count && *set.count < 1)
    throw InputError("count", std::to_string(*set.count), "at least 1");
  if (!(set.persistence > 0 && set.persistence <= 1))
    throw InputError("persistence", text(set.persistence), "> 0 and <= 1",
                     "a set without faces is left out of the sets");
  if (set.persistence < 1 && set.name.empty())
    throw InputError(
        "persistence", text(set.persistence), "1 where the set has no name",
        "give the set a name: its faces have the law of that name, the bridges between them that of "
        "the body");
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
      parts *= 1 + std::min((high - low) / set.spacing, static_cast<double>(set.count.value_or(INT_MAX)));
    }
    blocks += parts;
  }
  const auto closest = std::min_element(
      sets.begin(), sets.end(), [](const JointSet& a, const JointSet& b) { return a.spacing < b.spacing; });
  if (closest != sets.end())
    require_block_count("spacing", text(closest->spacing), blocks, "use a wider spacing or fewer blocks");
}

// The planes of one set, sorted along its mean normal.
class PlanesOfSet {
public:
  PlanesOfSet(const JointSet& set, std::uint64_t id, std::uint64_t seed, const Box& box)
      : set_(set), stream_(id << 32), seed_(seed), mean_(normal_of_dip(set.dip, set.dip_direction)),
        base_(set.origin.value_or(box.centre())), first_(mean_.dot(base_ - box.centre())) {
    const double tilt = std::min(widest_draw * (set.dip_scatter + set.direction_scatter), M_PI / 3);
    half_ = tilt > 0 ? 0.5 * box.size().norm() / portable::cos(tilt) // a tilted plane leans in from outside
                     : 0.5 * mean_.cwiseAbs().dot(box.size());
    const double wide = 2 * half_ + std::abs(first_);
    if (!(wide <= most_planes * set.spacing))
      throw InputError("spacing", text(set.spacing),
                       "such that there are at most a million planes in a set (this asks for about " +
                           text(std::round(wide / set.spacing)) + ")",
                       "use a wider spacing");
  }

  std::vector<Plane> all() const { return set_.origin || set_.count ? about_base() : from_lowest_corner(); }

private:
  bool scattered() const {
    return set_.spacing_scatter > 0 || set_.dip_scatter > 0 || set_.direction_scatter > 0;
  }
  // m, before the plane with this number.
  double gap(std::uint64_t k) const {
    const double limit = (1 - least_gap) / std::max(set_.spacing_scatter, 1e-12);
    return set_.spacing *
           (1 + set_.spacing_scatter * std::clamp(normal(seed_, stream_ + k, 0), -limit, limit));
  }
  // place: m from the base along the mean normal.
  Plane at(double place, std::uint64_t k) const {
    const auto draw = [&](std::uint64_t n) {
      return std::clamp(normal(seed_, stream_ + k, n), -widest_draw, widest_draw);
    };
    const Vec3 own = scattered() ? normal_of_dip(set_.dip + set_.dip_scatter * draw(1),
                                                 set_.dip_direction + set_.direction_scatter * draw(2))
                                 : mean_;
    return Plane::through(base_ + place * mean_, own);
  }
  // Without scatter one spacing apart, counted from the lowest corner of the box; with scatter the first place is drawn too.
  std::vector<Plane> from_lowest_corner() const {
    std::vector<Plane> planes;
    double place = -half_;
    if (scattered())
      place -= set_.spacing * uniform(seed_, stream_, 0);
    for (std::uint64_t k = 1;; ++k) {
      place += gap(k);
      if (place >= half_)
        return planes;
      planes.push_back(at(place, k));
    }
  }
  // The first runs through the base, the others follow on both sides. Numbers below it are even, above it odd.
  std::vector<Plane> about_base() const {
    const int count = set_.count.value_or(INT_MAX);
    std::vector<Plane> planes;
    const auto add = [&](double place, std::uint64_t k) {
      if (std::abs(first_ + place) < half_)
        planes.push_back(at(place, k));
    };
    double place = 0;
    for (int i = 0; i < (count - 1) / 2 && first_ + place > -half_; ++i)
      add(place -= gap(2 * static_cast<std::uint64_t>(i) + 2), 2 * static_cast<std::uint64_t>(i) + 2);
    std::reverse(planes.begin(), planes.end());
    add(0, 0);
    place = 0;
    for (int i = 0; i < count / 2 && first_ + place < half_; ++i)
      add(place += gap(2 * static_cast<std::uint64_t>(i) + 1), 2 * static_cast<std::uint64_t>(i) + 1);
    if (planes.empty())
      throw InputError(set_.origin ? "origin" : "count",
                       set_.origin ? text(*set_.origin) : std::to_string(count),
                       "such that a plane of the set crosses the blocks",
                       "move the origin, ask for more planes, or leave count out");
    return planes;
  }

  const JointSet& set_;
  std::uint64_t stream_, seed_; // of this set's planes
  Vec3 mean_, base_;
  double first_ = 0,
         half_ = 0; // m, along the mean normal: the base and the reach of the blocks, from their centre
};

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
Assembly cut_clear(Assembly assembly, const Plane& plane, double scale, PlaneCutOptions cut) {
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
  std::vector<std::size_t> order(sets.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(), [&](std::size_t s) { return sets[s].persistence == 1; });
  Assembly result = assembly;
  for (const std::size_t s : order) {
    PlaneCutOptions cut;
    cut.name = sets[s].name;
    std::uint64_t number = bridges_id + (s << 32); // of the plane
    if (sets[s].persistence < 1)
      cut.named = [&](std::size_t block) { return uniform(seed, number, block) < sets[s].persistence; };
    for (const Plane& plane : PlanesOfSet(sets[s], s, seed, box).all()) {
      throw_if_stopped();
      ++number;
      result = cut_clear(std::move(result), plane, std::min(sets[s].spacing, block_size), cut);
    }
  }
  return result;
}

} // namespace geom
