#include "apps/cdem/progress/time_left.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdem::app {

namespace {

constexpr std::size_t most_samples = 128; // the pairs of their second half are 2016 slopes

// The stage still goes on, though its goals are reached now: they have to last.
constexpr double most_done = 0.99;

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double decades(double value, double goal) {
  return std::isfinite(value) && value > 0 ? std::log10(value / goal) : std::nan("");
}

} // namespace

// 0 for what the stage does not wait for.
TimeLeft::Heights TimeLeft::goals(const Progress& progress) {
  return {progress.residual_goal, progress.kinetic_ratio_goal};
}

void TimeLeft::add(const Progress& progress, double wall) {
  if (progress.stage != stage_ || progress.step < last_.step)
    *this = TimeLeft();
  stage_ = progress.stage;
  last_ = progress;
  newest_ = {wall,
             static_cast<double>(progress.step),
             progress.time,
             {decades(progress.residual, progress.residual_goal),
              decades(progress.kinetic_ratio, progress.kinetic_ratio_goal)}};
  for (std::size_t i = 0; i < highest_.size(); ++i)
    highest_[i] = std::fmax(highest_[i], newest_.height[i]);
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

// 0 where it is reached; negative while it does not fall.
double TimeLeft::steps_to_goal(std::size_t which) const {
  std::vector<double> slopes;
  std::vector<double> heights; // now: the median over the last few samples
  const std::size_t first = samples_.size() / 2;
  for (std::size_t j = first; j < samples_.size(); ++j)
    for (std::size_t i = first; i < j; ++i) {
      const double run = samples_[j].step - samples_[i].step;
      const double slope = (samples_[j].height[which] - samples_[i].height[which]) / run;
      if (run > 0 && std::isfinite(slope))
        slopes.push_back(slope);
    }
  if (slopes.size() < 6)
    return -1;
  const double slope = std::min(0.0, median(slopes));
  for (std::size_t i = std::max(first, samples_.size() - std::min<std::size_t>(samples_.size(), 5));
       i < samples_.size(); ++i)
    if (std::isfinite(samples_[i].height[which]))
      heights.push_back(samples_[i].height[which] + slope * (newest_.step - samples_[i].step));
  if (heights.empty())
    return -1;
  const double height = median(heights);
  return height <= 0 ? 0 : slope < 0 ? height / -slope : -1;
}

double TimeLeft::steps_to_limit() const {
  return last_.max_steps > 0 ? static_cast<double>(last_.max_steps - last_.step) : -1;
}

double TimeLeft::steps_to_goals() const {
  double steps = -1;
  for (std::size_t i = 0; i < highest_.size(); ++i)
    if (goals(last_)[i] > 0) {
      const double own = steps_to_goal(i);
      if (own < 0)
        return -1;
      steps = std::max(steps, own);
    }
  return steps;
}

bool TimeLeft::gives_up() const {
  return steps_to_limit() >= 0 && steps_to_goals() > steps_to_limit();
}

double TimeLeft::seconds() const {
  if (last_.last)
    return 0;
  const double rate = steps_per_second();
  if (rate <= 0)
    return -1;
  const double steps = steps_to_goals();
  if (gives_up())
    return steps_to_limit() / rate;
  if (steps > 0)
    return steps / rate;
  if (steps == 0)
    return -1; // it waits for the goals to last, nobody knows how long
  const auto wanted = goals(last_);
  if (std::any_of(wanted.begin(), wanted.end(), [](double goal) { return goal > 0; }))
    return -1; // what does not fall says nothing, however far the limit is
  if (last_.time_goal > 0 && !samples_.empty() && newest_.time > samples_.front().time)
    return std::max(0.0, last_.time_goal - newest_.time) * (newest_.wall - samples_.front().wall) /
           (newest_.time - samples_.front().time);
  return steps_to_limit() >= 0 ? steps_to_limit() / rate : -1;
}

double TimeLeft::fraction() const {
  double done = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < highest_.size(); ++i) {
    if (!(goals(last_)[i] > 0))
      continue;
    const double height = newest_.height[i];
    if (std::isnan(height))
      return -1;
    done = std::min(done, height <= 0 ? 1 : 1 - height / highest_[i]); // the one furthest from its goal
  }
  if (std::isfinite(done))
    return last_.last ? done : std::min(done, most_done);
  if (last_.time_goal > last_.time_start)
    return std::min(1.0, (last_.time - last_.time_start) / (last_.time_goal - last_.time_start));
  return last_.max_steps > 0
             ? std::min(1.0, static_cast<double>(last_.step) / static_cast<double>(last_.max_steps))
             : -1;
}

} // namespace cdem::app
