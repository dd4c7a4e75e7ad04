// Tells an observer how far a stage is, about ten times a second, and at its end where its time went.
#pragma once

#include "libcdem/step/stage_context.hpp"
#include "libcdem/step/step_times.hpp"

#include <chrono>

namespace cdem {

class ProgressReporter {
public:
  ProgressReporter(const StageContext&, std::string kind);

  StepTimes times;
  const std::string& kind() const { return kind_; } // of the stage
  double wall_time() const;                         // s, of the stage so far
  bool due() const;
  // Adds which stage it is, what broke in it, and how fast it steps.
  void operator()(Progress, bool last);

private:
  Observer& observer_;
  RunLog& log_;
  int number_;
  std::string kind_;
  std::chrono::steady_clock::time_point start_, told_;
  std::int64_t step_; // then
};

} // namespace cdem
