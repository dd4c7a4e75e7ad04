#include "libgeom/placement/lattice.hpp"

#include "libgeom/core/random.hpp"
#include "libgeom/core/rotation.hpp"
#include "libgeom/placement/lowering.hpp"
#include "libgeom/placement/pile.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

constexpr std::size_t refined = 24;    // best tries that are improved
constexpr int refinements = 80;        // small turns tried for each
constexpr std::size_t family_size = 8; // attitudes at most
constexpr double apart = 20 * M_PI / 180;

// Every use has random numbers of its own.
constexpr std::uint64_t tries_id = std::uint64_t{1} << 40, turns_id = std::uint64_t{1} << 41;

struct Attitude {
  Mat3 rotation = Mat3::Identity();
  Profile profile;
  double height = 0; // m, of the centroid over the plane it stands on
  double cost = 0;   // m
};

class Search {
public:
  Search(const Surface& shape, const Spacing& s)
      : shape_(shape), neighbours_{Vec3(0.5 * s.across, s.rows, 0), Vec3(-0.5 * s.across, s.rows, 0),
                                   Vec3(s.across, 0, 0), Vec3(0, 2 * s.rows, 0)} {}

  Attitude at(const Mat3& rotation) const {
    double lowest = 0;
    for (const Vec3& x : shape_.points)
      lowest = std::min(lowest, rotation.row(2).dot(x));
    Attitude a{rotation, Profile(shape_, rotation), -lowest, 0};
    a.cost = a.height + 10 * rise(a, a);
    return a;
  }

  // m, what `later` has to be raised over neighbours of the other attitude, all standing on the plane.
  double rise(const Attitude& later, const Attitude& there) const {
    double most = 0;
    for (const Vec3& from : neighbours_) {
      const Vec3 offset = from + Vec3(0, 0, later.height - there.height);
      most = std::max(most, -clearance(later.profile, offset, there.profile, 0));
    }
    return most;
  }

private:
  const Surface& shape_;
  std::array<Vec3, 4> neighbours_;
};

bool cheaper(const Attitude& a, const Attitude& b) {
  return a.cost < b.cost;
}

Attitude improved(const Search& search, Attitude best, std::uint64_t seed, std::uint64_t id) {
  double size = 0.2; // radians
  for (int k = 0; k < refinements; ++k) {
    const auto draw = [&](std::uint64_t i) {
      return 2 * uniform(seed, turns_id + id, 3 * static_cast<std::uint64_t>(k) + i) - 1;
    };
    const Vec3 turn = size * Vec3(draw(0), draw(1), draw(2));
    Attitude other =
        search.at(rotation_about(turn.normalized(), turn.norm()).toRotationMatrix() * best.rotation);
    if (other.cost < best.cost)
      best = std::move(other);
    else
      size *= 0.96;
  }
  return best;
}

} // namespace

std::vector<Mat3> attitudes_for(const Surface& shape, const Spacing& spacing, int tries, std::uint64_t seed) {
  const Search search(shape, spacing);
  std::vector<Attitude> found;
  for (int i = 0; i < tries; ++i) {
    found.push_back(search.at(random_rotation(seed, tries_id + static_cast<std::uint64_t>(i))));
    // Only the best are kept, with their profiles.
    if (found.size() == 4 * refined) {
      std::stable_sort(found.begin(), found.end(), cheaper);
      found.erase(found.begin() + refined, found.end());
    }
  }
  std::stable_sort(found.begin(), found.end(), cheaper);
  found.erase(found.begin() + static_cast<std::ptrdiff_t>(std::min(found.size(), refined)), found.end());
  for (std::size_t i = 0; i < found.size(); ++i)
    found[i] = improved(search, std::move(found[i]), seed, i);
  std::stable_sort(found.begin(), found.end(), cheaper);

  // As much as the first one must be raised over its own kind, the others may be too, and a little more.
  const double allowed = search.rise(found.front(), found.front()) + 0.02 * found.front().height;
  std::vector<const Attitude*> family;
  for (const Attitude& a : found) {
    const bool fits = std::all_of(family.begin(), family.end(), [&](const Attitude* b) {
      return Eigen::AngleAxisd(a.rotation.transpose() * b->rotation).angle() >= apart &&
             search.rise(a, *b) <= allowed && search.rise(*b, a) <= allowed;
    });
    if (fits && family.size() < family_size)
      family.push_back(&a);
  }
  std::vector<Mat3> rotations;
  rotations.reserve(family.size());
  for (const Attitude* a : family)
    rotations.push_back(a->rotation);
  return rotations;
}

} // namespace geom
