// Rotation about an axis.
#pragma once

#include "libgeom/core/portable.hpp"
#include "libgeom/core/types.hpp"

namespace geom {

// axis: a unit vector; angle: rad. q = (cos(angle / 2), sin(angle / 2) axis)
inline Eigen::Quaterniond rotation_about(const Vec3& axis, double angle) {
  const Vec3 v = portable::sin(0.5 * angle) * axis;
  return {portable::cos(0.5 * angle), v.x(), v.y(), v.z()};
}

} // namespace geom
