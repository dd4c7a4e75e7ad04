// Is a block near failure, and along which plane would it fail? Numbers in, plane out (Han 2010 eqs 13-17 as amended
// in docs/theory.md). Principal stresses here are compression positive, sigma1 >= sigma2 >= sigma3.
//
//   tension   sigma1 + 3 sigma3 < 0 and sigma3 + sigma_t <= delta_t: plane normal to sigma3
//   shear     otherwise, Mohr-Coulomb excess on the critical plane
//             (sigma1 - sigma3) / (2 cos phi) - (sigma1 + sigma3) tan(phi) / 2 - c0 >= -delta_tau:
//             plane at 45 deg - phi/2 from the sigma1 axis, containing sigma2
//   griffith  instead of shear: (sigma1 - sigma3)^2 / (8 (sigma1 + sigma3)) - sigma_t >= -delta_t:
//             plane at 1/2 acos((sigma1 - sigma3) / (2 (sigma1 + sigma3))) from the sigma1 axis
//
// The stress is the same on the two conjugate planes. The plane with the larger |t . grad(u) . n| is taken, along which
// the block slides more; grad(u) includes the block's rotation. When both values are equal to 1e-6 of the larger, the
// plane that is turned from sigma1 towards sigma3 is taken, with both axes pointing so that their largest component is
// positive, and `tie` is set.
//
// Where two principal stresses are equal to 1e-4 of sigma1 - sigma3, their axes are free to rotate about the third, and
// rounding would decide. The axis of sigma3 (of sigma1, when sigma1 = sigma2) is then taken in the plane of the third
// axis and the first of x, y, z that stands at least 45 degrees off it: for models drawn in the x-y plane the plane of
// failure stands upright on it.
#pragma once

#include "libcdem/fracture/options.hpp"

#include <optional>

namespace cdem {

struct BlockStrength {
  double cohesion = 0;         // Pa
  double friction_angle = 0;   // rad
  double tensile_strength = 0; // Pa
};

struct FailurePlane {
  CutMode mode = CutMode::shear;
  geom::Vec3 normal = geom::Vec3::UnitX();
  geom::Vec3 principal = geom::Vec3::Zero(); // Pa, compression positive
  double angle_to_sigma1 = 0;                // rad, between plane and sigma1 axis
  bool tie = false;
};

// stress: Pa, tension positive. gradient: du_i/dx_j of the block, the whole model's rigid rotation taken out.
// Empty when the block is not near failure.
std::optional<FailurePlane> failure_plane(const geom::Mat3& stress, const geom::Mat3& gradient,
                                          const BlockStrength&, const RefineOptions&);

} // namespace cdem
