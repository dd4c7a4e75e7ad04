#include "libgeom/placement/overlap.hpp"

#include "libgeom/query/box_pairs.hpp"
#include "libgeom/query/triangle_distance.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

// Corners, middles of edges and of faces that lie in a box.
std::vector<Vec3> samples(const Surface& surface, const Box& box) {
  std::vector<Vec3> found;
  const auto add = [&](const Vec3& x) {
    if (box.contains(x))
      found.push_back(x);
  };
  for (const Vec3& x : surface.points)
    add(x);
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto [a, b, c] = surface.corners(i);
    add((a + b + c) / 3);
    for (const Vec3& middle : {Vec3(0.5 * (a + b)), Vec3(0.5 * (b + c)), Vec3(0.5 * (c + a))})
      add(middle);
  }
  return found;
}

double depth_in(const Vec3& x, const Surface& surface) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < surface.triangles.size(); ++i)
    least = std::min(least, distance(x, surface.corners(i)));
  return least;
}

} // namespace

// The solid angle under which the surface is seen is 4 pi from inside and 0 from outside (van Oosterom and
// Strackee 1983).
bool inside(const Vec3& point, const Surface& closed) {
  double angle = 0;
  for (std::size_t i = 0; i < closed.triangles.size(); ++i) {
    auto [a, b, c] = closed.corners(i);
    a -= point;
    b -= point;
    c -= point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle > 2 * M_PI;
}

std::optional<Overlap> deepest_overlap(const std::vector<Surface>& bodies, double tolerance) {
  std::vector<Box> boxes;
  boxes.reserve(bodies.size());
  for (const Surface& body : bodies)
    boxes.push_back(bounding_box(body));
  std::optional<Overlap> deepest;
  for (const auto& [a, b] : touching_pairs(boxes)) {
    const Box common{boxes[a].min.cwiseMax(boxes[b].min), boxes[a].max.cwiseMin(boxes[b].max)};
    for (const auto& [one, other] : {std::pair<int, int>{a, b}, {b, a}})
      for (const Vec3& x : samples(bodies[one], common)) {
        const double depth = depth_in(x, bodies[other]);
        if (depth > (deepest ? deepest->depth : tolerance) && inside(x, bodies[other]))
          deepest = Overlap{a, b, x, depth};
      }
  }
  return deepest;
}

} // namespace geom
