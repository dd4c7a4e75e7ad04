#include "libcdem/step/progress_reporter.hpp"

namespace cdem {
namespace {

constexpr double seconds_between = 0.1;

double since(std::chrono::steady_clock::time_point then) { // s
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

} // namespace

ProgressReporter::ProgressReporter(Observer& observer, RunLog& log, std::int64_t step)
    : observer_(observer), log_(log), told_(std::chrono::steady_clock::now()), step_(step) {}

bool ProgressReporter::due() const {
  return since(told_) > seconds_between;
}

void ProgressReporter::operator()(Progress progress, bool last) {
  const double passed = since(told_);
  progress.broken_tension = log_.broken_tension - log_.told_tension;
  progress.broken_shear = log_.broken_shear - log_.told_shear;
  progress.steps_per_second = passed > 0 ? static_cast<double>(progress.step - step_) / passed : 0;
  progress.last = last;
  if (last) {
    log_.told_tension = log_.broken_tension;
    log_.told_shear = log_.broken_shear;
  }
  step_ = progress.step;
  observer_.progress(progress);
  told_ = std::chrono::steady_clock::now();
}

} // namespace cdem
