// Code that looks at a running stage at times of its own, beside the stage's callback: the frames of a film.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>

namespace cdem {

struct TimedLook {
  std::int64_t steps = 0; // of the stage, between two looks; 0: by time
  double seconds = 0;     // s of the model, between two looks; a relaxation takes none
  std::function<void()> look;

  // After a step that took the model from one time to another (s). It depends on nothing else, so that a stage that is
  // resumed looks where it would have looked.
  bool due(std::int64_t step, double from, double to) const {
    return steps > 0 ? step % steps == 0 : number(to) > number(from);
  }

private:
  double number(double time) const { return std::floor(time / seconds + 1e-9); }
};

} // namespace cdem
