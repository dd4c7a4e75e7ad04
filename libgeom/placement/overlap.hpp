// Bodies that stand in each other.
#pragma once

#include "libgeom/mesh/surface.hpp"

#include <optional>

namespace geom {

bool inside(const Vec3& point, const Surface& closed);

struct Overlap {
  int a = 0, b = 0;          // a < b
  Vec3 place = Vec3::Zero(); // m
  double depth = 0;          // m
};

// The deepest of the places where a corner, the middle of an edge or of a face of one body lies more than
// `tolerance` (m) below the surface of another; none when there is no such place.
std::optional<Overlap> deepest_overlap(const std::vector<Surface>&, double tolerance);

} // namespace geom
