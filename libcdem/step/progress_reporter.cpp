#include "libcdem/step/progress_reporter.hpp"

#include <utility>

namespace cdem {
namespace {

constexpr double seconds_between = 0.1;

double since(std::chrono::steady_clock::time_point then) { // s
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

} // namespace

ProgressReporter::ProgressReporter(const StageContext& context, std::string kind)
    : observer_(context.observer), log_(context.log), number_(context.number), kind_(std::move(kind)),
      start_(std::chrono::steady_clock::now()), told_(start_), step_(context.from ? context.from->step : 0) {
  if (context.from)
    start_ -= std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(context.from->wall_time));
}

double ProgressReporter::wall_time() const {
  return since(start_);
}

bool ProgressReporter::due() const {
  return since(told_) > seconds_between;
}

void ProgressReporter::operator()(Progress progress, bool last) {
  const double passed = since(told_);
  progress.stage = number_;
  progress.kind = kind_;
  progress.wall_time = wall_time();
  progress.broken_tension = log_.broken_tension - log_.told_tension;
  progress.broken_shear = log_.broken_shear - log_.told_shear;
  progress.steps_per_second = passed > 0 ? static_cast<double>(progress.step - step_) / passed : 0;
  progress.last = last;
  // The times come first, then the loads of the ranks that the stage has told.
  progress.times = last ? times.text() + progress.times : "";
  if (last) {
    log_.told_tension = log_.broken_tension;
    log_.told_shear = log_.broken_shear;
  }
  step_ = progress.step;
  observer_.progress(progress);
  told_ = std::chrono::steady_clock::now();
}

} // namespace cdem
