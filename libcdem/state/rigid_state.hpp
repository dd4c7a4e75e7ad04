// Motion of a rigid body.
#pragma once

#include <array>

namespace cdem {

struct RigidState {
  std::array<double, 3> centroid{}; // m, where it is now
  std::array<double, 4> rotation{1, 0, 0,
                                 0}; // unit quaternion w x y z, from the directions it was made rigid in
  std::array<double, 3> velocity{};  // m/s, of the centroid, velocity_lag behind
  std::array<double, 3> angular_momentum{}; // kg m2/s about the centroid, velocity_lag behind
};

} // namespace cdem
