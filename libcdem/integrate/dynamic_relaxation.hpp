// Dynamic relaxation: central differences with fictitious masses, a unit step, and one damping for all (Han 2010 eq 12).
//
//   m (v+ - v-) = F - c m (v+ + v-) / 2,   u+ = u + v+
//   v+ = (2 - c) / (2 + c) v- + 2 / (2 + c) F / m
//
// One component: written for any number type, `double` or several side by side.
#pragma once

#include "libcdem/parallel/node.hpp"

namespace cdem {

class DynamicRelaxation {
public:
  explicit DynamicRelaxation(double damping)
      : damping_(damping), keep_((2 - damping) / (2 + damping)), push_(2 / (2 + damping)) {}

  template <class Number>
  CDEM_INLINE Number velocity_after(const Number& before, const Number& force, double mass) const {
    return keep_ * before + (push_ / mass) * force;
  }
  // J, in one step; mean: of the velocities before and after.
  template <class Number>
  CDEM_INLINE Number lost(const Number& mean, double mass) const {
    return damping_ * mass * mean * mean;
  }

private:
  double damping_, keep_, push_;
};

} // namespace cdem
