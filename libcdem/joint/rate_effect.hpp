// Strength raised by the rate of strain: a dynamic increase factor of one or two powers that meet,
//
//   DIF = (rate / rate_0)^a               up to rate_1, at least 1
//       = (rate_1 / rate_0)^a (rate / rate_1)^b   beyond
//
// The fib Model Code 2010 (section 5.1.11.2) has for concrete in tension rate_0 = 1e-6 1/s, a = 0.018, rate_1 = 10 1/s,
// b = 1/3.
#pragma once

#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <limits>

namespace cdem {

struct RateEffect {
  double reference_rate = 0;                                    // rate_0, 1/s; 0: no effect
  double exponent = 0;                                          // a
  double change_rate = std::numeric_limits<double>::infinity(); // rate_1, 1/s
  double exponent_above = 0;                                    // b
  bool fracture_energy = false;                                 // G_I and G_II are raised too

  bool on() const { return reference_rate > 0; }
};

inline double dynamic_increase_factor(const RateEffect& effect, double rate) { // 1/s
  if (!effect.on() || !(rate > effect.reference_rate))
    return 1;
  const auto power = [](double x, double exponent) {
    return geom::portable::exp(exponent * geom::portable::log(x));
  };
  const double below = power(std::min(rate, effect.change_rate) / effect.reference_rate, effect.exponent);
  return rate > effect.change_rate ? below * power(rate / effect.change_rate, effect.exponent_above) : below;
}

} // namespace cdem
