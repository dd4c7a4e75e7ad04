// Generalised Hoek-Brown strength of a rock mass (Hoek, Carranza-Torres and Corkum 2002, NARMS-TAC). Pressures p1 >= p3:
//
//   p1 = p3 + sigma_ci (m_b p3 / sigma_ci + s)^a
//
//   m_b = m_i exp((GSI - 100) / (28 - 14 D)),   s = exp((GSI - 100) / (9 - 3 D)),
//   a = 1/2 + (exp(-GSI / 15) - exp(-20 / 3)) / 6
//
// The curve is concave, so its tangents are Mohr-Coulomb strengths that nowhere fall below it, and its chords are strengths
// that nowhere exceed it between their ends. All that acts on Mohr-Coulomb acts on Hoek-Brown by the tangent at p3.
#pragma once

#include <vector>

namespace cdem {

struct HoekBrown {
  double sigma_ci = 0; // Pa, uniaxial strength of the intact rock; 0: no law
  double m = 0;        // m_b
  double s = 0;
  double a = 0.5;

  bool on() const { return sigma_ci > 0; }
};

struct RockMass {
  double sigma_ci = 0;            // Pa, > 0
  double geological_strength = 0; // GSI, in [5, 100]
  double intact_constant = 0;     // m_i, > 0
  double disturbance = 0;         // D, in [0, 1]
};

void validate(const RockMass&); // throws geom::InputError naming the field, its value and the allowed range
HoekBrown hoek_brown(const RockMass&);

double strength(const HoekBrown&, double p3);       // p1 at failure, Pa
double slope(const HoekBrown&, double p3);          // its derivative
double uniaxial_strength(const HoekBrown&);         // sigma_ci s^a, Pa
double uniaxial_tensile_strength(const HoekBrown&); // Pa: p1 = 0, at the pressure -p3

// A Mohr-Coulomb strength: p1 = q + n p3 with q = 2 c cos(phi) / (1 - sin(phi)), n = (1 + sin(phi)) / (1 - sin(phi)).
struct StraightStrength {
  double cohesion = 0; // Pa
  double sin_friction = 0, cos_friction = 1;
};

StraightStrength straight_strength(double q, double n);

// Touches the curve at p3; from tension on at that of the uniaxial tensile strength.
StraightStrength tangent(const HoekBrown&, double p3);

// Together they bear nothing that the curve does not, at any pressure from the uniaxial tensile strength on.
std::vector<StraightStrength> chords(const HoekBrown&);

} // namespace cdem
