// The least distance of two triangles that do not cut each other is between a corner of one and the other, or
// between two edges.
#include "libgeom/mesh/triangle_distance.hpp"

#include "libgeom/query/closest.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

double segment_distance(const Vec3& a, const Vec3& a_end, const Vec3& b, const Vec3& b_end) {
  const PlacesOnSegments at = nearest_on_segments(a, a_end, b, b_end);
  return (a + at.s * (a_end - a) - b - at.t * (b_end - b)).norm();
}

bool pierces(const Vec3& from, const Vec3& to, const TrianglePoints& t) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double above = normal.dot(from - t[0]), below = normal.dot(to - t[0]);
  if ((above > 0) == (below > 0))
    return false;
  const Vec3 x = from + above / (above - below) * (to - from);
  for (int i = 0; i < 3; ++i)
    if (normal.dot((t[(i + 1) % 3] - t[i]).cross(x - t[i])) < 0)
      return false;
  return true;
}

Box box_of(const TrianglePoints& t, double margin) {
  Box box;
  for (const Vec3& x : t)
    box.extend(x);
  box.min.array() -= margin;
  box.max.array() += margin;
  return box;
}

bool meet(const Box& a, const Box& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

struct Boxed {
  TrianglePoints points;
  Box box;
};

// Triangles near a box, with their own boxes.
std::vector<Boxed> near(const Surface& surface, const Box& box, double margin) {
  std::vector<Boxed> found;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const TrianglePoints points = surface.corners(i);
    const Box own = box_of(points, margin);
    if (meet(own, box))
      found.push_back({points, own});
  }
  return found;
}

} // namespace

double distance(const Vec3& point, const TrianglePoints& t) {
  const Vec3 w = nearest_on_triangle(point, t[0], t[1], t[2]).weights;
  return (point - w.x() * t[0] - w.y() * t[1] - w.z() * t[2]).norm();
}

double distance(const TrianglePoints& a, const TrianglePoints& b) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    if (pierces(a[i], a[(i + 1) % 3], b) || pierces(b[i], b[(i + 1) % 3], a))
      return 0;
    least = std::min({least, distance(a[i], b), distance(b[i], a)});
    for (int j = 0; j < 3; ++j)
      least = std::min(least, segment_distance(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
  }
  return least;
}

double distance(const Surface& a, const Surface& b, double limit) {
  Box box_a = bounding_box(a), box_b = bounding_box(b);
  for (Box* box : {&box_a, &box_b}) {
    box->min.array() -= limit;
    box->max.array() += limit;
  }
  if (!meet(box_a, box_b))
    return limit;
  double least = limit;
  const std::vector<Boxed> others = near(b, box_a, 0);
  for (const Boxed& one : near(a, box_b, limit))
    for (const Boxed& other : others)
      if (meet(one.box, other.box)) {
        least = std::min(least, distance(one.points, other.points));
        if (least == 0)
          return 0;
      }
  return least;
}

} // namespace geom
