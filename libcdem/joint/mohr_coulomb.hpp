// Strength of a bond or a rock: Mohr-Coulomb with a tension cut-off (Han 2010 eqs 10-11), for stresses and, times an
// area, for forces. This is the only implementation. Tension is positive.
//
//   t_n <= sigma_t,     |t_s| <= max(0, c - t_n tan(phi))
//
// In principal pressures, p1 the largest, the second reads
//
//   f = (p1 - p3) / (2 cos(phi)) - (p1 + p3) tan(phi) / 2 - c <= 0
#pragma once

#include "libcdem/joint/bond_mode.hpp"
#include "libcdem/parallel/node.hpp"

#include <algorithm>
#include <limits>

namespace cdem {

// Strength of a joint, Pa, or of a spring with an area, N.
struct SpringStrength {
  double cohesion = 0;         // c
  double tan_friction = 0;     // tan(phi)
  double tensile_strength = 0; // sigma_t
};

// c - t_n tan(phi): negative beyond the tip of the cone. T: one number or several side by side.
template <class T>
CDEM_INLINE T shear_strength(const T& cohesion, const T& tan_friction, const T& normal) {
  return cohesion - tan_friction * normal;
}

// What cohesion has to carry of a shear load, |t_s| + t_n tan(phi): at most c while the bond holds.
template <class T>
CDEM_INLINE T cohesive_load(const T& shear, const T& tan_friction, const T& normal) {
  return shear + normal * tan_friction;
}

inline BondMode breaks(const SpringStrength& s, double normal, double shear) {
  if (normal > s.tensile_strength)
    return BondMode::broken_tension;
  if (shear > std::max(0.0, shear_strength(s.cohesion, s.tan_friction, normal)))
    return BondMode::broken_shear;
  return BondMode::intact;
}

// Below this part of its strength no spring breaks, whatever the rounding of kernels that take several side by side.
constexpr double unbreakable_part = 0.98;

// f, Pa, > 0 where the rock fails.
inline double mohr_coulomb(double p1, double p3, double cohesion, double cos_friction, double tan_friction) {
  return (p1 - p3) / (2 * cos_friction) - (p1 + p3) * tan_friction / 2 - cohesion;
}

// How much of the strength a stress takes, 1 where the rock fails in shear: the radius of its Mohr circle over the
// largest about the same centre that the rock bears. Infinite beyond the tip of the cone.
inline double mohr_coulomb_utilisation(double p1, double p3, double cohesion, double cos_friction,
                                       double sin_friction) {
  const double most = cohesion * cos_friction + 0.5 * (p1 + p3) * sin_friction;
  return most > 0 ? 0.5 * (p1 - p3) / most : std::numeric_limits<double>::infinity();
}

} // namespace cdem
