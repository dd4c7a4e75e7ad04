// Coulomb friction: |t_s| <= p tan(phi) under the pressure p >= 0, for tractions and for forces. The only place where it
// stands. (Units that are laid, libgeom/placement, slide by impulses of their own.)
#pragma once

namespace cdem {

inline double friction_limit(double pressure, double tan_friction) {
  return pressure * tan_friction;
}

// The part of a trial shear load that friction holds, > 0 to 1: the return to the cone along the direction of the trial.
inline double held_by_friction(double trial, double limit) {
  return trial > limit ? limit / trial : 1;
}

} // namespace cdem
