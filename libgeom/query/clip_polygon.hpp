// Parts of convex polygons in a plane.
#pragma once

#include "libgeom/query/flat_fan.hpp"

namespace geom {

using Polygon = std::vector<Point>; // convex, counter-clockwise, m

// Leaves the part left of the line from a to b.
inline void clip(Polygon& polygon, const Point& a, const Point& b, Polygon& scratch) {
  scratch.clear();
  const Point along = b - a;
  const auto side = [&](const Point& p) { return along.x() * (p.y() - a.y()) - along.y() * (p.x() - a.x()); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double sp = side(p), sq = side(q);
    if (sp >= 0)
      scratch.push_back(p);
    if ((sp > 0 && sq < 0) || (sp < 0 && sq > 0))
      scratch.push_back(p + sp / (sp - sq) * (q - p));
  }
  polygon.swap(scratch);
}

// Whether its area exceeds a strip of this width along its edges.
inline bool wider_than(double width, const Polygon& polygon) {
  double twice_area = 0, perimeter = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point p = polygon[i] - polygon[0], q = polygon[(i + 1) % polygon.size()] - polygon[0];
    twice_area += p.x() * q.y() - p.y() * q.x();
    perimeter += (q - p).norm();
  }
  return std::abs(twice_area) > width * perimeter;
}

} // namespace geom
