// Isotropic linear elasticity (Han 2010 eq 3): sigma = lambda tr(eps) I + 2 G eps.
#pragma once

#include <string>

namespace cdem {

struct Elastic {
  double youngs_modulus = 0; // E, Pa, > 0
  double poissons_ratio = 0; // nu, in (-1, 0.5)
  double density = 0;        // rho, kg/m3, > 0
  double viscosity = 0;      // mu of Han 2010 eq 1, force per volume and velocity, N s/m4, >= 0
  // beta of Rayleigh damping, s, >= 0: meshes carry beta C : D beside their stress, D the strain rate. A vibration of
  // angular frequency w has beta w / 2 of critical damping; motion as a rigid body has none.
  double stiffness_damping = 0;

  double shear_modulus() const { return youngs_modulus / (2 * (1 + poissons_ratio)); } // G, Pa
  double lame_lambda() const {
    return youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio)); // Pa
  }
  double p_wave_modulus() const { return lame_lambda() + 2 * shear_modulus(); } // Pa
};

// Throws geom::InputError naming the field, its value and the allowed range.
void validate(const Elastic&);

} // namespace cdem
