// Mohr-Coulomb plasticity with tension cut-off: principal stresses beyond the strength of a rock return to it.
//
// Stress is tension positive, s1 >= s2 >= s3. With N = friction angle phi, dilation angle psi, cohesion c, tensile
// strength T (at most c / tan(phi), the tip of the cone):
//
//   f_ij = (1 + sin phi) s_i - (1 - sin phi) s_j - 2 c cos phi <= 0      of (1,3), and at its edges (1,2) and (2,3)
//   f_i  = s_i - T <= 0
//
// flow along b_ij = (1 + sin psi) e_i - (1 - sin psi) e_j and b_i = e_i. A trial stress t beyond returns by Koiter's rule
//
//   s = t - sum over the active planes of l_a C b_a,   l_a >= 0,   f_a(s) = 0,   f(s) <= 0 for all others
//
// with C Hooke's law of principal stresses (lambda, G). Sets of one, two and three planes are tried in this order: faces,
// edges, corners. All is linear, so that a set is solved exactly; there is no iteration (Clausen, Damkilde and Andersen
// 2007, Computers & Structures 85, take the same four kinds of return).
//
// With a Hoek-Brown strength (joint/hoek_brown.hpp) c and phi are those of its tangent at the pressure p3 = -s1 of the
// returned stress. Newton's method finds it: the tangent at the last stress gives the next one.
//
// c, tan(phi) and T fall linearly from their peak to their residual value over the equivalent plastic strain
// k = sum sqrt(2/3 de : de) of the plastic strain e, from 0 to `softening_strain`; so does the strength p1 of
// Hoek-Brown at every p3. They are those of the beginning of the step.
#pragma once

#include "libcdem/joint/hoek_brown.hpp"

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace cdem {

struct Plasticity {
  double cohesion = 0;         // c, Pa, >= 0
  double friction_angle = 0;   // phi, rad, in [0, pi/2)
  double dilation_angle = 0;   // psi, rad, in [0, phi]
  double tensile_strength = 0; // T, Pa, >= 0
  // Values left at softening_strain; the same as the peak where nothing softens.
  double residual_cohesion = 0;              // Pa
  double residual_friction_angle = 0;        // rad
  double residual_tensile_strength = 0;      // Pa
  double softening_strain = 0;               // k, 0: nothing softens
  HoekBrown curve = {}, residual_curve = {}; // in place of c and phi
};

// Throws geom::InputError naming the field, its value and the allowed range. Angles are printed in degrees.
void validate(const Plasticity&);

// Strength divided by a factor: c / F, tan(phi) / F, T / F, the residual ones too; psi at most phi.
Plasticity reduced(Plasticity, double factor);
bool has_strength(const Plasticity&);

// Laws of a body: of its regions, and of all others.
struct PlasticLaws {
  std::vector<Plasticity> laws;             // empty: the body is elastic
  std::vector<std::pair<int, int>> regions; // region of the mesh (from 0), index into laws
  int others = -1;                          // index into laws of all other regions; -1: they are elastic

  bool empty() const { return laws.empty(); }
  int of_region(int region) const {
    for (const auto& [number, law] : regions)
      if (number == region)
        return law;
    return others;
  }
};

// At a plastic strain.
struct RockLimit {
  double cohesion = 0, sin_friction = 0, cos_friction = 1, sin_dilation = 0, tensile_strength = 0;
  // Where it is on, (1 - fallen) p1 of the curve + fallen p1 of the residual one stands in place of c and phi.
  HoekBrown curve = {}, residual_curve = {};
  double fallen = 0;
};
RockLimit limit_at(const Plasticity&, double plastic_strain);

struct PlasticReturn {
  std::array<double, 3> stress{}; // Pa
  std::array<double, 3> strain{}; // plastic
  int planes = 0;                 // how many were active, 0: elastic
};

// trial: Pa, descending. lambda, shear: Lame's moduli, Pa.
PlasticReturn return_to_limit(const std::array<double, 3>& trial, double lambda, double shear,
                              const RockLimit&);

// Returns a whole tensor to the strength, in place: xx yy zz xy yz xz, Pa. Returns the plastic work per volume, J/m3:
// the mean of the stress `before` the step and the one after it, times the plastic strain. plastic_strain: k, advanced.
double plastic_step(const RockLimit&, double lambda, double shear, const double (&before)[6],
                    double (&stress)[6], double& plastic_strain);

// For a kernel that looks at many stresses: below it no plane is reached, whatever the plastic strain. With the mean
// stress p and J2 of the deviator,
//
//   s1 - s3 <= 2 sqrt(J2),   |s2 - p| <= sqrt(J2 / 3),   s1 - p <= 2 sqrt(J2 / 3)
struct PlasticBound {
  double strength = 0, slope = 0; // R = strength - slope p: beyond where R <= 0 or reach J2 >= R^2
  double reach = 0;
  double tensile = 0; // beyond where tensile <= p or 4/3 J2 >= (tensile - p)^2
};
// One with the peak strengths and one with the residual ones; of Hoek-Brown one for each chord.
std::vector<PlasticBound> bounds(const Plasticity&);

} // namespace cdem
