#include "apps/cdem/progress/time_left.hpp"

#include <algorithm>
#include <cmath>

namespace cdem::app {

namespace {

constexpr std::size_t most_samples = 128; // the pairs of their second half are 2016 slopes

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool usable(double residual) {
  return std::isfinite(residual) && residual > 0;
}

} // namespace

void TimeLeft::add(const Progress& progress, double wall) {
  if (progress.stage != stage_ || progress.step < last_.step)
    *this = TimeLeft();
  stage_ = progress.stage;
  last_ = progress;
  newest_ = {wall, static_cast<double>(progress.step),
             usable(progress.residual) ? std::log10(progress.residual) : std::nan("")};
  if (usable(progress.residual))
    highest_residual_ = std::max(highest_residual_, progress.residual);
  if (calls_++ % stride_ != 0)
    return;
  samples_.push_back(newest_);
  if (samples_.size() < most_samples)
    return;
  for (std::size_t i = 0; 2 * i < samples_.size(); ++i)
    samples_[i] = samples_[2 * i];
  samples_.resize(most_samples / 2);
  stride_ *= 2;
}

double TimeLeft::steps_per_second() const {
  if (last_.steps_per_second > 0)
    return last_.steps_per_second;
  if (samples_.empty())
    return 0;
  const Sample& from = samples_[samples_.size() / 2 == samples_.size() - 1 ? 0 : samples_.size() / 2];
  const double wall = newest_.wall - from.wall;
  return wall > 0 ? std::max(0.0, (newest_.step - from.step) / wall) : 0;
}

double TimeLeft::steps_to_residual() const {
  std::vector<double> slopes;
  std::vector<double> heights; // log10(residual) above the goal, now: the median over the last few samples
  const std::size_t first = samples_.size() / 2;
  for (std::size_t j = first; j < samples_.size(); ++j)
    for (std::size_t i = first; i < j; ++i) {
      const double run = samples_[j].step - samples_[i].step;
      const double slope = (samples_[j].log_residual - samples_[i].log_residual) / run;
      if (run > 0 && std::isfinite(slope))
        slopes.push_back(slope);
    }
  if (slopes.size() < 6)
    return -1;
  const double slope = median(slopes);
  if (slope >= 0)
    return -1;
  const double goal = std::log10(last_.residual_goal);
  for (std::size_t i = std::max(first, samples_.size() - std::min<std::size_t>(samples_.size(), 5));
       i < samples_.size(); ++i)
    if (std::isfinite(samples_[i].log_residual))
      heights.push_back(samples_[i].log_residual + slope * (newest_.step - samples_[i].step) - goal);
  return heights.empty() ? -1 : std::max(0.0, median(heights) / -slope);
}

double TimeLeft::seconds() const {
  if (last_.last)
    return 0;
  if (last_.seconds_left >= 0)
    return last_.seconds_left;
  const double rate = steps_per_second();
  if (rate <= 0)
    return -1;
  const double steps_to_limit = last_.max_steps > 0 ? static_cast<double>(last_.max_steps - last_.step) : -1;
  if (last_.residual_goal > 0) {
    const double steps = steps_to_residual();
    // A residual that does not fall says nothing, however far the limit is.
    return steps < 0 ? -1 : (steps_to_limit >= 0 ? std::min(steps, steps_to_limit) : steps) / rate;
  }
  if (last_.time_goal > 0 && last_.time > 0 && !samples_.empty()) {
    const double done = last_.time / last_.time_goal;
    return done >= 1 ? 0 : (newest_.wall - samples_.front().wall) * (1 - done) / done;
  }
  return steps_to_limit >= 0 ? steps_to_limit / rate : -1;
}

double TimeLeft::fraction() const {
  double done = -1;
  if (last_.residual_goal > 0 && usable(last_.residual) && highest_residual_ > last_.residual_goal)
    done =
        std::log10(highest_residual_ / last_.residual) / std::log10(highest_residual_ / last_.residual_goal);
  else if (last_.time_goal > 0)
    done = last_.time / last_.time_goal;
  else if (last_.residual_goal <= 0 && last_.max_steps > 0)
    done = static_cast<double>(last_.step) / static_cast<double>(last_.max_steps);
  return done < 0 ? done : std::min(1.0, done);
}

} // namespace cdem::app
