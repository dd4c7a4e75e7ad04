// What contacts do to a rigid body, all of them together.
#pragma once

#include "libgeom/core/types.hpp"

namespace cdem {

struct ContactOnRigid {
  geom::Vec3 force = geom::Vec3::Zero(), torque = geom::Vec3::Zero(); // N, N m about the centroid
  double frequency2 = 0;                                              // 1/s2, a bound (Gershgorin)
  bool touches = false;
};

} // namespace cdem
