// Strength reduction (Zienkiewicz, Humpheson and Lewis 1975): the factor of safety is the number by which all strengths
// have to be divided for the model to fail,
//
//   c / F,   tan(phi) / F,   sigma_t / F
//
// Stiffness, fracture energies, scatter and rate stay; glued faces never break.
#pragma once

#include "libcdem/joint/joint.hpp"
#include "libcdem/joint/law_reduction.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

// rad
inline double reduced_friction_angle(double friction_angle, double factor) {
  return geom::portable::atan2(geom::portable::tan(friction_angle), factor);
}

inline Joint reduced(Joint joint, double factor) {
  if (joint.glued)
    return joint;
  require_straight(joint.curve);
  joint.cohesion /= factor;
  joint.friction_angle = reduced_friction_angle(joint.friction_angle, factor);
  joint.tensile_strength /= factor;
  // A factor below 1 raises the strengths; those of a joint that softens stay on its cone.
  const double tangent = geom::portable::tan(joint.friction_angle);
  if (joint.softening != Softening::none && tangent > 0)
    joint.tensile_strength = std::min(joint.tensile_strength, joint.cohesion / tangent);
  joint.law = reduced(joint.law, factor);
  return joint;
}

inline bool has_strength(const Joint& joint) {
  return !joint.glued &&
         (joint.cohesion > 0 || joint.friction_angle > 0 || joint.tensile_strength > 0 || has_law(joint.law));
}

} // namespace cdem
