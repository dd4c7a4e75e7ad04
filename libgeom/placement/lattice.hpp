// Attitudes in which units of one shape fit beside each other in the pattern of a layer.
//
// In the pattern each unit has four neighbours that are already laid: to its left and right in the row below, at its
// side in its own row, and two rows below. The cost of an attitude has two terms. The first is the height of the
// centroid when the unit stands on a plane. The second is ten times the height by which the unit must be raised to
// stand over such neighbours in the same attitude. Units in attitudes of low cost lie flat and side by side.
#pragma once

#include "libgeom/mesh/surface.hpp"

#include <cstdint>

namespace geom {

struct Spacing {
  double across = 0, rows = 0; // m, between units of a row, between rows
};

// A family of attitudes that fit beside each other and themselves, of low cost, at least 20 degrees apart; one at
// least. Relative to the plane's axes: along the row, towards the next row, out of the plane. `shape` about its
// centroid.
std::vector<Mat3> attitudes_for(const Surface& shape, const Spacing&, int tries, std::uint64_t seed);

} // namespace geom
