// Mohr-Coulomb after the peak: residual cohesion, friction and tensile strength, and dilation.
//
//   |t_s| <= c_r + p tan(phi_r)     once it has slipped; with the peak's friction until then
//   pull  <= T_r                    however far it opens; back on the line to the origin
//   opening by slip  d = s tan(psi)   up to the slip s_max, then no more
//
// s is the slip since the faces fitted together. When the slip reverses, the opening decreases along the same straight
// line. Slip dissipates (|t_s| - p tan(psi)) per length; the rest of the work lifts the load on the joint. So psi is at
// most phi_r.
#pragma once

#include "libcdem/joint/joint_spring.hpp"

#include <limits>

namespace cdem {

struct ResidualStrength : LinearClosure {
  double cohesion = 0;                                             // c_r, Pa
  double friction = 0;                                             // tan(phi_r)
  double tension = 0;                                              // T_r, Pa
  double dilation = 0;                                             // tan(psi)
  double dilation_limit = std::numeric_limits<double>::infinity(); // s_max, m

  double strength(const JointSpring& spring, double pressure, double path) const {
    return std::max(0.0, cohesion + pressure * (path > 0 ? friction : spring.tan_friction));
  }
  double rise(const JointSpring&, double, double, double slip_before, double slip_after) const {
    return dilation * (std::min(slip_after, dilation_limit) - std::min(slip_before, dilation_limit));
  }
  double pull(const JointSpring& spring, double opening, double parted) const {
    const double furthest = std::max(parted, tension / spring.kn);
    return opening < furthest ? tension * opening / furthest : tension;
  }
  double stored_pull(const JointSpring& spring, double opening, double parted) const {
    return 0.5 * pull(spring, opening, parted) * opening;
  }
  double friction_left(const JointSpring&) const { return friction; }

  void validate() const {
    require_of_joint(std::isfinite(cohesion) && cohesion >= 0, "residual_cohesion", cohesion,
                     "a finite number >= 0 Pa");
    require_of_joint(std::isfinite(friction) && friction >= 0, "residual_friction_angle", friction,
                     "the tangent of an angle in [0, 90) degrees");
    require_of_joint(std::isfinite(tension) && tension >= 0, "residual_tensile_strength", tension,
                     "a finite number >= 0 Pa");
    require_of_joint(dilation >= 0 && dilation <= friction, "dilation_angle",
                     std::atan(dilation) * (180 / 3.14159265358979323846),
                     "in [0, residual friction angle] degrees",
                     "a joint that rises more steeply than it rubs would give energy");
    require_of_joint(dilation_limit >= 0, "dilation_limit", dilation_limit, "a number >= 0 m");
  }
  static void validate(const JointSpring&) {}
  template <class Visit>
  void each_member(const Visit& visit) {
    visit(cohesion);
    visit(friction);
    visit(tension);
    visit(dilation);
    visit(dilation_limit);
  }
};

} // namespace cdem
