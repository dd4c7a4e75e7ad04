// Between two faces that overlap as seen from above, the height is least over a corner of one of them or where two
// edges cross: it is linear in between.
#include "libgeom/placement/lowering.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

using Point = Eigen::Vector2d;

constexpr double seen = 1e-9; // faces nearer to the line of sight are but their edges, which others have too

double cross(const Point& a, const Point& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Height of a face at (x, y), when it is there.
bool height_at(const TrianglePoints& t, const Point& p, double& height) {
  double weight[3], area = 0;
  for (int i = 0; i < 3; ++i) {
    const Point a = t[(i + 1) % 3].head<2>(), b = t[(i + 2) % 3].head<2>();
    weight[i] = cross(b - a, p - a);
    area += weight[i];
  }
  for (const double w : weight)
    if (w * area < 0)
      return false;
  height = (weight[0] * t[0].z() + weight[1] * t[1].z() + weight[2] * t[2].z()) / area;
  return true;
}

double edge_clearance(const Vec3& a, const Vec3& a_end, const Vec3& b, const Vec3& b_end, double least) {
  const Point u = (a_end - a).head<2>(), v = (b_end - b).head<2>(), w = (b - a).head<2>();
  const double turn = cross(u, v);
  if (std::abs(turn) <= 1e-12 * u.norm() * v.norm()) // alongside each other: their ends decide
    return least;
  const double s = cross(w, v) / turn, t = cross(w, u) / turn;
  if (s < 0 || s > 1 || t < 0 || t > 1)
    return least;
  return std::min(least, a.z() + s * (a_end.z() - a.z()) - b.z() - t * (b_end.z() - b.z()));
}

double face_clearance(const TrianglePoints& above, const TrianglePoints& below, double least) {
  for (int i = 0; i < 3; ++i) {
    double height = 0;
    if (height_at(below, above[i].head<2>(), height))
      least = std::min(least, above[i].z() - height);
    if (height_at(above, below[i].head<2>(), height))
      least = std::min(least, height - below[i].z());
    for (int j = 0; j < 3; ++j)
      least = edge_clearance(above[i], above[(i + 1) % 3], below[j], below[(j + 1) % 3], least);
  }
  return least;
}

bool meet(const Point& low, const Point& high, const Point& other_low, const Point& other_high) {
  return (low.array() <= other_high.array()).all() && (other_low.array() <= high.array()).all();
}

} // namespace

Profile::Profile(const Surface& surface, const Mat3& frame) {
  std::vector<Vec3> points;
  points.reserve(surface.points.size());
  for (const Vec3& x : surface.points) {
    points.emplace_back(frame * x);
    low = low.cwiseMin(points.back().head<2>());
    high = high.cwiseMax(points.back().head<2>());
  }
  for (const Triangle& t : surface.triangles) {
    Face face;
    face.points = {points[t[0]], points[t[1]], points[t[2]]};
    const auto& [a, b, c] = face.points;
    face.low = a.cwiseMin(b).cwiseMin(c).head<2>();
    face.high = a.cwiseMax(b).cwiseMax(c).head<2>();
    face.bottom = std::min({a.z(), b.z(), c.z()});
    face.top = std::max({a.z(), b.z(), c.z()});
    const Vec3 area = (b - a).cross(c - a);
    if (area.z() < -seen * area.norm())
      lower.push_back(face);
    else if (area.z() > seen * area.norm())
      upper.push_back(face);
  }
  std::stable_sort(lower.begin(), lower.end(),
                   [](const Face& one, const Face& other) { return one.bottom < other.bottom; });
  std::stable_sort(upper.begin(), upper.end(),
                   [](const Face& one, const Face& other) { return one.top > other.top; });
}

Mat3 frame_along(const Vec3& up) {
  const Vec3 z = up.normalized();
  const Vec3 x = (std::abs(z.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY()).cross(z).normalized();
  Mat3 frame;
  frame << x.transpose(), z.cross(x).transpose(), z.transpose();
  return frame;
}

double clearance(const Profile& above, const Vec3& offset, const Profile& below, double limit) {
  const Point across = offset.head<2>();
  if (above.lower.empty() || below.upper.empty() ||
      !meet(above.low + across, above.high + across, below.low, below.high))
    return limit;
  double least = limit;
  std::vector<const Profile::Face*> under; // those of the other that may be below, by top falling
  for (const Profile::Face& face : below.upper)
    if (meet(above.low + across, above.high + across, face.low, face.high))
      under.push_back(&face);
  for (const Profile::Face& face : above.lower) {
    if (under.empty() || face.bottom + offset.z() - under.front()->top >= least)
      break;
    TrianglePoints moved = face.points;
    for (Vec3& x : moved)
      x += offset;
    for (const Profile::Face* other : under) {
      if (face.bottom + offset.z() - other->top >= least)
        break;
      if (meet(face.low + across, face.high + across, other->low, other->high))
        least = face_clearance(moved, other->points, least);
    }
  }
  return least;
}

} // namespace geom
