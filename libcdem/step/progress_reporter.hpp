// Tells an observer how far a stage is, about ten times a second.
#pragma once

#include "libcdem/results/log.hpp"
#include "libcdem/step/observer.hpp"

#include <chrono>

namespace cdem {

class ProgressReporter {
public:
  ProgressReporter(Observer&, RunLog&, std::int64_t step); // from this step of the stage on

  bool due() const;
  // Adds what broke in the stage, and how fast it steps.
  void operator()(Progress, bool last);

private:
  Observer& observer_;
  RunLog& log_;
  std::chrono::steady_clock::time_point told_;
  std::int64_t step_; // then
};

} // namespace cdem
