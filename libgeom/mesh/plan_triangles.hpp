// Points as a surface: the triangles of Delaunay in plan (CGAL), such as those between water levels measured in boreholes.
#pragma once

#include "libgeom/mesh/surface.hpp"

namespace geom {

// Over the convex hull of the points in plan, seen from above counter-clockwise. The same points in the same order give the
// same triangles on every processor. Throws InputError, `field` first, for fewer than three points, points that are not
// finite, two over one place, and points on one line in plan.
Surface plan_triangles(const std::vector<Vec3>& points, const std::string& field);

} // namespace geom
