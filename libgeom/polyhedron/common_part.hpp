// Common part of two convex blocks: one block cut by all the faces of the other.
#pragma once

#include "libgeom/polyhedron/polyhedron.hpp"

#include <optional>
#include <vector>

namespace geom {

std::vector<Plane> face_planes(const Polyhedron&); // outward, one for each face

// True when a face of one block has all vertices of the other outside, or less than `depth` (m) inside. Settles all but a
// few pairs of blocks; false says nothing.
bool apart(const std::vector<Plane>& planes, const Polyhedron& other, double depth);

// The part of `block` below all the planes; none when nothing is left. tolerance (m): as of cut.
std::optional<Polyhedron> common_part(const Polyhedron& block, const std::vector<Plane>& planes,
                                      double tolerance);

} // namespace geom
