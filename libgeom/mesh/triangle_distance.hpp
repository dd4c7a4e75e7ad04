// How far two triangles are apart, and two surfaces of them.
#pragma once

#include "libgeom/mesh/surface.hpp"

namespace geom {

using TrianglePoints = std::array<Vec3, 3>;

// m; 0 when they touch or cut each other.
double distance(const TrianglePoints&, const TrianglePoints&);
double distance(const Vec3& point, const TrianglePoints&);

// m, the least distance between triangles of the two; 0 when they cut each other. Looked for up to `limit`
// only: where they are further apart it is `limit`.
double distance(const Surface&, const Surface&, double limit);

} // namespace geom
