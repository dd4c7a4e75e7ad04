// The joint of the softening tests.
#pragma once

#include "tests/libcdem/system.hpp"

namespace testing {

inline cdem::Joint softening_joint(cdem::Softening curve) {
  cdem::Joint j;
  j.cohesion = 2e6;
  j.friction_angle = 30 * degree;
  j.tensile_strength = 1e6;
  j.softening = curve;
  j.fracture_energy_1 = 50;
  j.fracture_energy_2 = 200;
  return j;
}

} // namespace testing
