// Coulomb friction: |t_s| <= p tan(phi) under the pressure p >= 0, for tractions and for forces. The only
// implementation of this law. (Units that are laid, libgeom/placement, slide by their own impulses.)
#pragma once

#include "libcdem/parallel/node.hpp"

namespace cdem {

// T: one number or several side by side.
template <class T>
CDEM_INLINE T friction_limit(const T& pressure, const T& tan_friction) {
  return pressure * tan_friction;
}

// The part of a trial shear load that friction holds, > 0 to 1: the return to the cone along the direction of the trial.
template <class T>
CDEM_INLINE T held_by_friction(const T& trial, const T& limit) {
  return trial > limit ? limit / trial : T{} + 1.0;
}

} // namespace cdem
