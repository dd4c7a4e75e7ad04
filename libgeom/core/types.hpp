// Vectors, planes and boxes that the whole toolkit shares.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace geom {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Triangle = std::array<int, 3>; // node indices, counter-clockwise seen from outside
using Tet = std::array<int, 4>;      // node indices, positive volume: (x1-x0) . ((x2-x0) x (x3-x0)) > 0

// Level set of Han 2010 eq 18: phi(x) = normal . x - offset; phi > 0 above, 0 on the plane, < 0 below.
struct Plane {
  Vec3 normal = Vec3::UnitZ(); // unit vector
  double offset = 0;           // m

  double level(const Vec3& x) const { return normal.dot(x) - offset; }
  static Plane through(const Vec3& point, const Vec3& normal) {
    const Vec3 n = normal.normalized();
    return {n, n.dot(point)};
  }
};

struct Box {
  Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 max = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void extend(const Vec3& x) {
    min = min.cwiseMin(x);
    max = max.cwiseMax(x);
  }
  Vec3 size() const { return max - min; }
  Vec3 centre() const { return 0.5 * (min + max); }
  bool contains(const Vec3& x, double tolerance = 0) const {
    return ((x - min).array() >= -tolerance).all() && ((max - x).array() >= -tolerance).all();
  }
};

} // namespace geom
