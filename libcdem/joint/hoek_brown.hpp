// Generalised Hoek-Brown strength of a rock mass (Hoek, Carranza-Torres and Corkum 2002, Proc. NARMS-TAC, Toronto, vol. 1,
// pp. 267-273). With the principal pressures p1 >= p3:
//
//   p1 = p3 + sigma_ci (m_b p3 / sigma_ci + s)^a
//
//   m_b = m_i exp((GSI - 100) / (28 - 14 D)),   s = exp((GSI - 100) / (9 - 3 D)),
//   a = 1/2 + (exp(-GSI / 15) - exp(-20 / 3)) / 6
//
// The curve is concave. Its tangents are Mohr-Coulomb strengths that are nowhere below it, and its chords are strengths that
// are nowhere above it between their ends. So code for Mohr-Coulomb serves Hoek-Brown too, with the tangent at p3.
#pragma once

#include <vector>

namespace cdem {

struct HoekBrown {
  double sigma_ci = 0; // Pa, uniaxial compressive strength of the intact rock; 0: no law
  double m_b = 0;
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

// Throws geom::InputError naming the field, its value and the allowed range.
void validate(const RockMass&);
HoekBrown hoek_brown(const RockMass&);

double strength(const HoekBrown&, double p3);       // p1 at failure, Pa
double slope(const HoekBrown&, double p3);          // its derivative
double uniaxial_tensile_strength(const HoekBrown&); // Pa: -p3 at p1 = 0

// A Mohr-Coulomb strength p1 = q + n p3, with q = 2 c cos(phi) / (1 - sin(phi)) and n = (1 + sin(phi)) / (1 - sin(phi)).
struct StraightStrength {
  double cohesion = 0; // Pa
  double sin_friction = 0, cos_friction = 1;
};

StraightStrength straight_strength(double q, double n);

// Touches the curve at p3; below the uniaxial tensile strength, there.
StraightStrength tangent(const HoekBrown&, double p3);

// The tangent that also touches the envelope of the Mohr circles at this pressure on a plane: p3 + (p1 - p3) / (n + 1).
StraightStrength tangent_on_plane(const HoekBrown&, double pressure);

// Strength reduction divides the numbers of a straight strength: throws geom::InputError where the curve is on.
void require_straight(const HoekBrown&);

// Straight strengths of which one at least is not above the curve, at any p3 from the uniaxial tensile strength on.
std::vector<StraightStrength> chords(const HoekBrown&);

} // namespace cdem
