#include "libcdem/load/record.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

constexpr double usual_gap = 2.5; // over the median step

std::vector<double> integral(const std::vector<double>& time, const std::vector<double>& rate) {
  std::vector<double> sum(time.size());
  for (std::size_t i = 1; i < time.size(); ++i)
    sum[i] = sum[i - 1] + 0.5 * (rate[i] + rate[i - 1]) * (time[i] - time[i - 1]);
  return sum;
}

// Integral of a velocity that is parabolic between two samples with known accelerations: exact up to the last
// displacement.
double displacement(const TimeTable& acceleration, const std::vector<double>& velocity) {
  double sum = 0;
  for (std::size_t i = 1; i < velocity.size(); ++i) {
    const double dt = acceleration.time[i] - acceleration.time[i - 1];
    sum += velocity[i - 1] * dt + dt * dt * (2 * acceleration.value[i - 1] + acceleration.value[i]) / 6;
  }
  return sum;
}

} // namespace

void require_no_gaps(const TimeTable& table, double longest, const std::vector<int>& lines) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < table.time.size(); ++i)
    steps.push_back(table.time[i] - table.time[i - 1]);
  std::vector<double> sorted = steps;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double median = sorted[sorted.size() / 2], most = longest > 0 ? longest : usual_gap * median;
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (steps[i] > most)
      throw geom::InputError(
          fmt::format("a gap from {:g} to {:g} s ({}), its usual step is {:g} s; fill the missing "
                      "samples, or say longest_step = {:g} where straight lines across gaps will do",
                      table.time[i], table.time[i + 1],
                      lines.empty() ? fmt::format("points {} and {}", i + 1, i + 2)
                                    : fmt::format("lines {} and {}", lines[i], lines[i + 1]),
                      median, steps[i]));
}

VelocityRecord integrate(const TimeTable& acceleration, bool straight_baseline) {
  const double first = acceleration.time.front(), duration = acceleration.time.back() - first;
  VelocityRecord r;
  r.velocity = acceleration;
  r.velocity.value = integral(acceleration.time, acceleration.value);
  r.raw_end_velocity = r.end_velocity = r.velocity.value.back();
  r.raw_end_displacement = r.end_displacement = displacement(acceleration, r.velocity.value);
  if (!straight_baseline)
    return r;
  const double v = r.end_velocity / duration, d = r.end_displacement / (duration * duration);
  r.baseline = {6 * d - 2 * v, (6 * v - 12 * d) / duration};
  TimeTable corrected = acceleration;
  for (std::size_t i = 0; i < corrected.time.size(); ++i)
    corrected.value[i] -= r.baseline.constant + r.baseline.slope * (corrected.time[i] - first);
  r.velocity.value = integral(corrected.time, corrected.value);
  // The baseline makes both 0: what rounding leaves is none of the motion.
  const auto rounded = [](double end, double raw) { return std::abs(end) < 1e-9 * std::abs(raw) ? 0 : end; };
  r.end_velocity = rounded(r.velocity.value.back(), r.raw_end_velocity);
  r.end_displacement = rounded(displacement(corrected, r.velocity.value), r.raw_end_displacement);
  return r;
}

double peak(const TimeTable& table) {
  double largest = 0;
  for (const double value : table.value)
    largest = std::max(largest, std::abs(value));
  return largest;
}

} // namespace cdem
