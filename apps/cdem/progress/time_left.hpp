// How long a stage still takes. A relaxation's residual falls like exp(-rate step), with ripples: the rate is
// the median slope of log10(residual) between samples of the second half of the stage so far (Theil and Sen),
// which no ripple or outlier can turn. Other stages go by time or steps done.
#pragma once

#include "libcdem/step/observer.hpp"

#include <cstdint>
#include <vector>

namespace cdem::app {

class TimeLeft {
public:
  // wall: s on any steady clock. A new stage number starts over. Samples are thinned by halves, so that
  // memory and time stay bounded however long the stage.
  void add(const Progress&, double wall);

  double seconds() const;          // wall time to the end of the stage; negative when unknown
  double steps_per_second() const; // over the last samples; 0 when unknown
  double fraction()
      const; // done, 0 to 1: of the residual's fall in decades, of time, or of steps; negative when unknown

private:
  struct Sample {
    double wall, step, log_residual;
  };
  double steps_to_residual() const;

  Progress last_;
  int stage_ = 0;
  double highest_residual_ = 0;
  std::int64_t stride_ = 1, calls_ = 0;
  std::vector<Sample> samples_;
  Sample newest_{};
};

} // namespace cdem::app
