// The least distance of two triangles that do not cut each other is between a corner of one and the other, or
// between two edges (Ericson, "Real-Time Collision Detection", 2005, 5.1.5 and 5.1.9).
#include "libgeom/query/triangle_distance.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

Vec3 nearest_point(const Vec3& p, const TrianglePoints& t) {
  const auto& [a, b, c] = t;
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0)
    return a;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3)
    return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0)
    return a + d1 / (d1 - d3) * ab;
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6)
    return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0)
    return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

double segment_distance(const Vec3& p, const Vec3& p_end, const Vec3& q, const Vec3& q_end) {
  const Vec3 u = p_end - p, v = q_end - q, w = p - q;
  const double a = u.squaredNorm(), e = v.squaredNorm(), f = v.dot(w), c = u.dot(w), b = u.dot(v);
  const double across = a * e - b * b;
  double s = across > 1e-14 * a * e ? std::clamp((b * f - c * e) / across, 0., 1.) : 0;
  double t = e > 0 ? (b * s + f) / e : 0;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0., 1.);
    s = a > 0 ? std::clamp((b * t - c) / a, 0., 1.) : 0;
  }
  return (w + s * u - t * v).norm();
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
  return (point - nearest_point(point, t)).norm();
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
