// Rough joints after Barton and Bandis: closure on a hyperbola (Bandis, Lumsden and Barton 1983, Int. J. Rock Mech. Min. Sci.
// 20(6)), strength from roughness JRC, wall strength JCS and residual angle phi_r (Barton and Choubey 1977, Rock Mech. 10),
// mobilised with slip (Barton, Bandis and Bakhtar 1985, Int. J. Rock Mech. Min. Sci. 22(3)).
//
//   p    = k_ni v / (1 - v / V_m)                          v closure
//   |t_s| <= p tan(phi_r + i m),   i = JRC log10(JCS / p)  roughness angle, degrees
//   psi  = i m / 2                                         dilation angle, where m > 0
//
// m is the part of the roughness that a slip of the length `path` has mobilised, straight between the points
//
//   path / d_p   0       0.3   0.6   1   2     4     10    25    100
//   m         -phi_r/i    0   0.75   1  0.85  0.70  0.50  0.40    0
//
// For a joint of the length L_n, against samples of L_0:
//
//   JRC_n = JRC_0 (L_n / L_0)^(-0.02 JRC_0),   JCS_n = JCS_0 (L_n / L_0)^(-0.03 JRC_0)
//   d_p   = L_n / 500 (JRC_n / L_n)^0.33       slip at the peak, L_n in m
//
// Without a length m = 1: the peak strength holds at any slip, and there is no dilation. phi_r + i is at most 70 degrees,
// i at least 0. The hyperbola goes on straight where it would become stiffer than the spring of the interface.
#pragma once

#include "libcdem/joint/joint_spring.hpp"
#include "libgeom/core/portable.hpp"

namespace cdem {

struct BartonBandis : NoPull {
  double jrc = 0;               // JRC_n
  double jcs = 0;               // JCS_n, Pa
  double residual_angle = 0;    // phi_r, rad
  double initial_stiffness = 0; // k_ni, Pa/m
  double maximum_closure = 0;   // V_m, m
  double peak_slip = 0;         // d_p, m; 0: m = 1

  static constexpr double degree = 3.14159265358979323846 / 180;
  static constexpr double steepest =
      70 * degree; // of phi_r + i, Barton and Choubey's advice for low pressures

  // i, rad; pressure > 0.
  double roughness_angle(double pressure) const {
    const double decades = geom::portable::log(jcs / pressure) / 2.302585092994046;
    return std::max(0.0, std::min(jrc * decades * degree, steepest - residual_angle));
  }
  // m of a part of the peak's slip, where it is >= 0.3.
  static double mobilised(double part) {
    constexpr double points[][2] = {{0.3, 0},  {0.6, 0.75}, {1, 1},     {2, 0.85},
                                    {4, 0.70}, {10, 0.50},  {25, 0.40}, {100, 0}};
    for (int i = 1; i < 8; ++i)
      if (part <= points[i][0])
        return points[i - 1][1] + (points[i][1] - points[i - 1][1]) * (part - points[i - 1][0]) /
                                      (points[i][0] - points[i - 1][0]);
    return 0;
  }
  // phi_r + i m, rad: the secant angle of the strength.
  double friction_angle(double pressure, double path) const {
    if (peak_slip == 0)
      return residual_angle + roughness_angle(pressure);
    const double part = path / peak_slip;
    if (part < 0.3)
      return residual_angle * part / 0.3;
    return residual_angle + roughness_angle(pressure) * mobilised(part);
  }
  double strength(const JointSpring&, double pressure, double path) const {
    return pressure > 0 ? pressure * geom::portable::tan(friction_angle(pressure, path)) : 0;
  }
  // tan of the slope of the peak strength over the pressure: with t = p tan(a), dt/dp = tan(a) + p (1 + tan^2 a) da/dp.
  double tangent(double pressure) const {
    const double i = roughness_angle(pressure), t = geom::portable::tan(residual_angle + i);
    const bool bounded = i == 0 || i == steepest - residual_angle;
    return t - (bounded ? 0 : (1 + t * t) * jrc * degree / 2.302585092994046);
  }
  double rise(const JointSpring&, double pressure, double path, double slip_before, double slip_after) const {
    if (peak_slip == 0 || !(pressure > 0) || !(path > 0.3 * peak_slip))
      return 0;
    return geom::portable::tan(0.5 * roughness_angle(pressure) * mobilised(path / peak_slip)) *
           (slip_after - slip_before);
  }
  double friction_left(const JointSpring&) const { return geom::portable::tan(residual_angle); }

  // v* from which on the spring of the interface is the softer: k_ni / (1 - v / V_m)^2 = k_n.
  double straight_from(const JointSpring& spring) const {
    return maximum_closure * (1 - std::sqrt(std::min(1.0, initial_stiffness / spring.kn)));
  }
  double hyperbola(double closure) const {
    return initial_stiffness * closure / (1 - closure / maximum_closure);
  }
  double pressure(const JointSpring& spring, double closure) const {
    const double straight = straight_from(spring);
    return closure <= straight ? hyperbola(closure) : hyperbola(straight) + spring.kn * (closure - straight);
  }
  double closure(const JointSpring& spring, double pressure) const {
    const double straight = straight_from(spring), there = hyperbola(straight);
    return pressure <= there ? pressure / (initial_stiffness + pressure / maximum_closure)
                             : straight + (pressure - there) / spring.kn;
  }
  double stored(const JointSpring& spring, double closure) const {
    const double straight = straight_from(spring), curved = std::min(closure, straight),
                 x = curved / maximum_closure;
    const double beyond = closure - curved;
    return initial_stiffness * maximum_closure * maximum_closure * (-geom::portable::log(1 - x) - x) +
           beyond * (hyperbola(straight) + 0.5 * spring.kn * beyond);
  }

  void validate() const {
    require_of_joint(jrc >= 0 && jrc <= 20, "jrc", jrc, "in [0, 20]",
                     "0 is smooth and planar, 20 the roughest of Barton's profiles");
    require_of_joint(std::isfinite(jcs) && jcs > 0, "jcs", jcs, "a finite number > 0 Pa",
                     "the strength of the joint walls; rock has 1e7 to 3e8 Pa");
    require_of_joint(residual_angle >= 0 && residual_angle < steepest, "residual_friction_angle",
                     residual_angle / degree, "in [0, 70) degrees");
    require_of_joint(std::isfinite(initial_stiffness) && initial_stiffness > 0, "initial_stiffness",
                     initial_stiffness, "a finite number > 0 Pa/m");
    require_of_joint(std::isfinite(maximum_closure) && maximum_closure > 0, "maximum_closure",
                     maximum_closure, "a finite number > 0 m", "rock joints have 1e-5 to 1e-3 m");
    require_of_joint(std::isfinite(peak_slip) && peak_slip >= 0, "peak_slip", peak_slip,
                     "a finite number >= 0 m");
  }
  void validate(const JointSpring& spring) const {
    char most[64];
    std::snprintf(most, sizeof most, "at most %g Pa/m, the stiffness of the spring", spring.kn);
    require_of_joint(initial_stiffness <= spring.kn, "initial_stiffness", initial_stiffness, most,
                     "raise normal_stiffness, or lower thickness_ratio");
  }
  template <class Visit>
  void each_member(const Visit& visit) {
    visit(jrc);
    visit(jcs);
    visit(residual_angle);
    visit(initial_stiffness);
    visit(maximum_closure);
    visit(peak_slip);
  }
};

// JRC, JCS and the slip at the peak of a joint of this length (m) from those of samples of `sample_length` (m).
inline void scale_to_length(BartonBandis& law, double length, double sample_length) {
  const auto power = [](double x, double exponent) {
    return geom::portable::exp(exponent * geom::portable::log(x));
  };
  const double jrc = law.jrc, ratio = length / sample_length;
  law.jrc = jrc * power(ratio, -0.02 * jrc);
  law.jcs *= power(ratio, -0.03 * jrc);
  law.peak_slip = jrc > 0 ? length / 500 * power(law.jrc / length, 0.33) : 0;
}

} // namespace cdem
