// Common part of two convex blocks: what lies below all planes of both.
#pragma once

#include "libgeom/polyhedron/polyhedron.hpp"

#include <vector>

namespace geom {

std::vector<Plane> face_planes(const Polyhedron&); // outward, one for each face

// True when a face of one block has all vertices of the other outside, or less than `depth` (m) inside. Settles all but a
// few pairs of blocks; false says nothing.
bool apart(const std::vector<Plane>& planes, const Polyhedron& other, double depth);

struct CommonPart {
  double volume = 0;            // m3
  Vec3 centroid = Vec3::Zero(); // m; where the volume is above 0
};

// region: a box that holds the common part. The part is never built as a polyhedron, so no near miss of a vertex and a
// plane can spoil it: each plane brings the polygon that the other planes leave of it, and the pyramid above that polygon.
CommonPart common_part(const std::vector<Plane>& one, const std::vector<Plane>& other, const Box& region);

} // namespace geom
