// Joint laws whose strengths are divided by a factor F, for a factor of safety: at any pressure, slip and opening the reduced
// law bears the strength of the law over F. Closure and dilation stay, with one exception: the dilation angle is at
// most the reduced residual friction angle. A joint with more dilation than friction would create energy.
#pragma once

#include "libcdem/joint/joint_law.hpp"

namespace cdem {

inline ResidualStrength reduced(ResidualStrength law, double factor) {
  law.cohesion /= factor;
  law.friction /= factor;
  law.tension /= factor;
  law.dilation = std::min(law.dilation, law.friction);
  return law;
}

inline JointTable reduced(JointTable law, double factor) {
  for (auto& row : law.shear)
    row[1] /= factor;
  return law;
}

[[noreturn]] inline BartonBandis reduced(const BartonBandis&, double) {
  throw geom::InputError(
      "reduce: a Barton-Bandis joint has no strength that a factor divides: its friction angle falls with "
      "the pressure; give the joint as cdem.joint_table{ shear = ... }, or as cdem.coulomb");
}

inline JointLaw reduced(const JointLaw& law, double factor) {
  if (!has_law(law))
    return law;
  return with_law(law, [&](const auto& own) -> JointLaw { return reduced(own, factor); });
}

} // namespace cdem
