// What holds two faces together, and what is left when it has broken: springs in series with nothing else
// (Han 2010 eq 8) with a tension and a Mohr-Coulomb limit (eqs 10-11).
#pragma once

#include <optional>

namespace cdem {

struct Joint {
  bool bonded = true;         // false: a contact from the start (tension free, friction only)
  double cohesion = 0;        // c0, Pa, >= 0
  double friction_angle = 0;  // phi, rad, in [0, pi/2)
  double tensile_strength = 0; // sigma_t, Pa, >= 0

  // Stiffness per area kn = E/L, ks = G/L with the moduli of the two blocks in series and L the equivalent thickness,
  // unless the stiffness is given.
  double thickness_ratio = 0.02;          // L over the block size h = cube root of its volume, > 0
  std::optional<double> thickness;        // L, m, > 0; wins over the ratio
  std::optional<double> normal_stiffness; // kn, Pa/m, > 0
  std::optional<double> shear_stiffness;  // ks, Pa/m, > 0
};

// Throws geom::InputError naming the field, its value and the allowed range. Angles are printed in degrees.
void validate(const Joint&);

} // namespace cdem
