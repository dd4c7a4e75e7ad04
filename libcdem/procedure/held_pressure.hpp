// The pressure of a flow over time, Pa: p = min(limit, base + rate (t - base_time)), but for holds, which keep it.
#pragma once

#include <algorithm>

namespace cdem {

struct HeldPressure {
  double base_time = 0, base = 0, rate = 0, limit = 0; // s, Pa, Pa/s, Pa
  double resume = -1;                                  // s; >= 0: held until then

  double at(double time) const {
    return resume >= 0 ? base : std::min(limit, base + rate * (time - base_time));
  }
  void hold(double time, double until) {
    base = at(time);
    base_time = time;
    resume = until;
  }
  void go_on(double time) {
    base_time = time;
    resume = -1;
  }
};

} // namespace cdem
