// Remaining time of a stage. The residual of a relaxation, or the kinetic energy of units that settle, falls to its
// goal like exp(-rate step), with ripples. The rate is the median slope of its logarithm between samples of the second
// half of the stage so far (Theil and Sen), which ripples and outliers do not affect. For other stages the time or the
// steps done give the estimate.
#pragma once

#include "libcdem/step/observer.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace cdem::app {

class TimeLeft {
public:
  // wall: s on any steady clock. A new stage number, or a step before the last one, starts over. Samples are thinned by
  // halves, so that memory and time stay bounded however long the stage.
  void add(const Progress&, double wall);

  double seconds() const; // wall time to the end of the stage; negative when unknown
  // Whether it ends then as it may take no more steps, short of its goal.
  bool gives_up() const;
  double steps_per_second() const; // over the last samples; 0 when unknown
  // Done, 0 to 1: of what has to fall in decades, of time, or of steps; negative when unknown.
  double fraction() const;

private:
  // Decades above the goal of the residual and of the kinetic energy; NaN: unknown, or no goal.
  using Heights = std::array<double, 2>;
  struct Sample {
    double wall = 0, step = 0, time = 0;
    Heights height{};
  };
  static Heights goals(const Progress&);
  double steps_to_goal(std::size_t which) const;
  double steps_to_goals() const; // all of them; negative when unknown, or there are none
  double steps_to_limit() const; // negative when there is none

  Progress last_;
  int stage_ = 0;
  Heights highest_{};
  std::int64_t stride_ = 1, calls_ = 0;
  std::vector<Sample> samples_;
  Sample newest_;
};

} // namespace cdem::app
