// What contacts do to a rigid body, summed without rounding: whichever rank adds which contact, the sums have the same bits.
#pragma once

#include "libcdem/parallel/exact_sum.hpp"
#include "libgeom/core/types.hpp"

#include <array>

namespace cdem {

inline geom::Vec3 values(const std::array<ExactSum, 3>& sums) {
  return {sums[0].value(), sums[1].value(), sums[2].value()};
}

struct RigidSums {
  std::array<ExactSum, 3> force, torque; // N, N m about the centroid
  ExactSum frequency2;                   // 1/s2
  bool touches = false;

  template <class Act>
  void each(const Act& act) {
    for (ExactSum& sum : force)
      act(sum);
    for (ExactSum& sum : torque)
      act(sum);
    act(frequency2);
  }
};

} // namespace cdem
