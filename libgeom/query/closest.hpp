// Nearest places of points, triangles and lines (Ericson 2005, "Real-Time Collision Detection", 5.1).
#pragma once

#include "libgeom/core/types.hpp"

namespace geom {

// Where on a triangle: x = sum weights[i] corner[i], weights >= 0, their sum 1.
struct PlaceOnTriangle {
  Vec3 weights = Vec3::Zero();
  bool inside = false; // no weight is 0: neither on an edge nor on a corner
};
PlaceOnTriangle nearest_on_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c);

// The places a0 + s (a1 - a0) and b0 + t (b1 - b0) of two segments that are nearest to each other, s and t in [0, 1].
struct PlacesOnSegments {
  double s = 0, t = 0;
};
PlacesOnSegments nearest_on_segments(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

} // namespace geom
