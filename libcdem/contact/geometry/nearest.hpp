// The nearest place of a fragment's surface to a semi-spring, triangle by triangle, and whether the spring is inside.
#pragma once

#include "libcdem/contact/geometry/positions.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/query/closest.hpp"

#include <cmath>

namespace cdem {

// Two points nearer to each other than these fractions of a distance and of a tet's height are one point, as on an edge
// that two triangles share. Tets that a bond holds together have edges of their own, which separate by the opening of the
// bond: `gives` below, a fraction of the height that is larger than that of one point.
inline constexpr double same_place = 1e-6, same_place_at_least = 1e-9;

// The nearest point of a fragment to a spring, so far. Several triangles may share it. The target is the triangle whose
// plane is furthest from the spring. The sum of the normals tells whether the spring is inside. Each normal is weighted
// by the angle that its triangle fills there (Baerentzen and Aanaes 2005): a single normal may be wrong at a sharp
// corner or at the mouth of a crack.
struct Nearest {
  int target = -1;
  double distance2 = 0;
  double height = 0; // of the spring over the target's plane, m: below 0 behind it
  geom::PlaceOnTriangle at;
  geom::Vec3 place = geom::Vec3::Zero();
  geom::Vec3 outward = geom::Vec3::Zero(); // sum of the normals, weighted
  geom::Vec3 from = geom::Vec3::Zero();    // m, the spring from the place

  // It is behind the target, too: pushed out, what is over it would go further. From within a closed surface the nearest
  // place is on no edge but one that is turned in, and the spring is behind both triangles there.
  bool inside() const { return target >= 0 && outward.dot(from) < 0 && height < 0; }
};

// rad, that the triangle fills around a place of it.
inline double angle_at(const geom::PlaceOnTriangle& at, const Corners& x) {
  for (int i = 0; i < 3; ++i)
    if (at.weights[(i + 1) % 3] == 0 && at.weights[(i + 2) % 3] == 0) {
      const geom::Vec3 a = x[(i + 1) % 3] - x[i], b = x[(i + 2) % 3] - x[i];
      return geom::portable::atan2(a.cross(b).norm(), a.dot(b));
    }
  return at.inside ? 2 * M_PI : M_PI;
}

inline Nearest nearest_of(int target, const geom::Vec3& spring, const Corners& x, const geom::Vec3& normal) {
  Nearest found;
  found.target = target;
  found.at = geom::nearest_on_triangle(spring, x[0], x[1], x[2]);
  found.place = weighted(x, found.at.weights);
  found.from = spring - found.place;
  found.distance2 = found.from.squaredNorm();
  found.height = found.from.dot(normal);
  return found;
}

// size: m, of the tets there; gives: of their edges, over the size.
inline void take_nearer(Nearest& nearest, Nearest other, const Corners& x, const geom::Vec3& normal,
                        double size, double gives) {
  const bool bonded = gives > same_place_at_least;
  const double further = std::sqrt(std::max(nearest.distance2, other.distance2));
  const double apart = further - std::sqrt(std::min(nearest.distance2, other.distance2));
  double reach = same_place * further + gives * size;
  // A small change of distance moves the nearest place far along an edge that runs across.
  if (bonded && apart <= reach)
    reach += std::sqrt(2 * further * reach);
  // One of the two may have its place just off the edge. Within both they are the two sides of a crack.
  const bool on_edges = !nearest.at.inside || !other.at.inside;
  const bool one_place = nearest.target >= 0 && (on_edges || !bonded) &&
                         (other.place - nearest.place).squaredNorm() <= reach * reach;
  if (!one_place && nearest.target >= 0 && other.distance2 >= nearest.distance2)
    return;
  other.outward = angle_at(other.at, x) * normal;
  if (one_place)
    other.outward += nearest.outward;
  // Places that bonds have parted count as one for the side that the spring is on, not for how deep it is.
  const bool as_near = apart <= same_place * further + same_place_at_least * size;
  const bool stays =
      as_near ? std::abs(other.height) <= std::abs(nearest.height) : other.distance2 >= nearest.distance2;
  if (one_place && stays)
    nearest.outward = other.outward;
  else
    nearest = other;
}

} // namespace cdem
