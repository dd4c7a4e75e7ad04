// The nearest place of a fragment's surface to a semi-spring, triangle by triangle, and whether the spring is inside.
#pragma once

#include "libcdem/contact/geometry/positions.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/query/closest.hpp"

#include <cmath>
#include <cstdint>

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
  bool in_tet = false;                     // the spring is in a tet of the fragment

  // It is behind the target, too: pushed out, what is over it would go further. From within a closed surface the nearest
  // place is on no edge but one that is turned in, and the spring is behind both triangles there.
  bool inside() const { return target >= 0 && (in_tet || (outward.dot(from) < 0 && height < 0)); }
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

// A triangle's place against the nearest before: further off; one place with it; nearer.
enum class Taken : std::uint8_t { no, beside, instead };

// size: m, of the tets there; gives: of their edges, over the size.
inline Taken take_nearer(Nearest& nearest, Nearest other, const Corners& x, const geom::Vec3& normal,
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
    return Taken::no;
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
  return one_place ? Taken::beside : Taken::instead;
}

// m, that the place stands outside the tet that a triangle bounds, at least; below 0: it is inside. apex: the tet's corner
// that is not the triangle's; height: m, over the triangle's plane.
inline double outside_tet(const Corners& x, const geom::Vec3& apex, const geom::Vec3& place, double height) {
  double outside = height;
  for (int i = 0; i < 3; ++i) {
    const geom::Vec3 &a = x[i], &b = x[(i + 1) % 3];
    outside = std::max(outside, (apex - a).cross(b - a).normalized().dot(place - a));
  }
  return outside;
}

// The nearest place of a fragment of several tets. Both sides of a crack may be equally near to a spring, and near the
// crack's end they belong to one fragment: then the nearest triangle does not tell on which side of the surface the spring
// is. But a spring in the tet of the nearest triangle that it is behind is inside, and gets out only where it is behind one.
struct NearestOfTets {
  Nearest of_all, behind; // behind: without triangles that the spring stands over
  bool in_tet = false;

  // apex: gives the corner of the triangle's tet that is not the triangle's.
  template <class Apex>
  void add(const Nearest& found, const Corners& x, const geom::Vec3& normal, double size, double gives,
           const geom::Vec3& spring, const Apex& apex) {
    take_nearer(of_all, found, x, normal, size, gives);
    if (found.at.inside && found.height >= 0)
      return;
    const Taken taken = take_nearer(behind, found, x, normal, size, gives);
    if (taken != Taken::no)
      in_tet = (taken == Taken::beside && in_tet) ||
               (found.height < 0 && outside_tet(x, apex(), spring, found.height) <= 0);
  }
  Nearest found() const {
    if (!in_tet)
      return of_all;
    Nearest found = behind;
    found.in_tet = true;
    return found;
  }
};

// m, that a spring which stands outside a fragment of several tets may go, at least, before one triangle makes it stand
// inside. The surface that it sees need not be closed: parts of the fragment that hang together elsewhere are pressed into
// each other, and cracks end in it. So a triangle counts that the spring is behind, once it is the nearest, counts as one place
// with it, or its tet holds the spring. No contact begins deeper than `shallow`. on: its place on that triangle; least: m, to
// the nearest; one_place: m, places so much further off than the nearest may count as one with it.
template <class Apex>
double outside_until(const Nearest& on, const Corners& x, const geom::Vec3& spring, double least,
                     double one_place, double shallow, const Apex& apex) {
  const double distance = std::sqrt(on.distance2), nearest = 0.5 * (distance - least - one_place),
               behind = on.height - one_place - std::sqrt(2 * distance * one_place),
               known = std::max(0.5 * (distance - shallow), behind);
  if (known >= nearest)
    return known;
  return std::max(known, std::min(nearest, 0.5 * outside_tet(x, apex(), spring, on.height)));
}

} // namespace cdem
