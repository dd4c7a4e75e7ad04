// The joint of two faces, bonded or broken: springs (Han 2010 eq 8) with a tension limit and a Mohr-Coulomb limit (eqs
// 10-11), beyond which they break or soften.
#pragma once

#include "libcdem/joint/hoek_brown.hpp"
#include "libcdem/joint/joint_law.hpp"
#include "libcdem/joint/rate_effect.hpp"
#include "libcdem/joint/strength_scatter.hpp"

#include <optional>

namespace cdem {

// How a bond's cohesive part falls from its strength to nothing (joint/softening.hpp).
enum class Softening { none, linear, exponential }; // none: brittle, as in Han 2010

struct Joint {
  bool bonded = true;          // false: a contact from the start (tension free, friction only)
  bool glued = false;          // bonded and never breaks: the face of a construction cut, no joint
  double cohesion = 0;         // c0, Pa, >= 0
  double friction_angle = 0;   // phi, rad, in [0, pi/2)
  double tensile_strength = 0; // sigma_t, Pa, >= 0

  // Work per crack area from nothing to full separation, elastic part included; beyond friction in mode II.
  // Both 0 without softening; with it both at least what the spring stores at its strength, and 0 < sigma_t
  // <= c0 / tan(phi).
  Softening softening = Softening::none;
  double fracture_energy_1 = 0; // G_I, J/m2
  double fracture_energy_2 = 0; // G_II, J/m2

  // Stiffness per area kn = E/L, ks = G/L with the moduli of the two blocks in series and L the equivalent
  // thickness, unless the stiffness is given.
  double thickness_ratio = 0.02;          // L over the block size h = cube root of its volume, > 0
  std::optional<double> thickness;        // L, m, > 0; wins over the ratio
  std::optional<double> normal_stiffness; // kn, Pa/m, > 0
  std::optional<double> shear_stiffness;  // ks, Pa/m, > 0

  // beta of Rayleigh damping, s, >= 0: between blocks that move far, springs that hold or press carry beta k times the
  // rate of their stretch beside their force.
  double stiffness_damping = 0;

  // e, in (0, 1]: speed after over speed before an impact, as far as the contact decides it. 1: it loses nothing.
  double restitution = 1;

  StrengthScatter scatter = {}; // of sigma_t and c0 together, from face to face; the energies stay
  RateEffect rate = {};         // of cohesive bodies

  // Between blocks: how a spring that is broken or never was bonded bears pressure and shear; with a law other than
  // ResidualStrength it was never bonded.
  JointLaw law = {};

  // Replaces cohesion and friction where a crack of a brittle face in a cohesive body begins. The crack keeps the friction.
  HoekBrown curve = {};
};

// L over the block size of glued faces: a quarter of a joint's usual give. Stiffer ones would only cost steps.
inline constexpr double glued_thickness_ratio = 0.005;

Joint glued_joint();

// tan(phi) of the contact that is left once two blocks have parted.
double friction_left(const Joint&);

// Throws geom::InputError naming the field, its value and the allowed range. Angles are printed in degrees.
void validate(const Joint&);

// The same for the fracture energies of a softening joint and for laws, once the stiffness of its springs is known (kn, ks,
// Pa/m).
void validate(const Joint&, double normal_stiffness, double shear_stiffness);

} // namespace cdem
