#include "libcdem/vtk/chart_axis.hpp"

#include "libcdem/vtk/labels.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

void set_linear_range(ChartAxis& axis, double low, double high, bool padded) {
  if (low > 0 && low < 0.35 * high) // near zero: show zero
    low = 0;
  if (high < 0 && high > 0.35 * low)
    high = 0;
  if (low == high) {
    const double half = low != 0 ? 0.5 * std::abs(low) : 0.5;
    low -= half;
    high += half;
  }
  const double pad = padded ? 0.04 * (high - low) : 0;
  axis.low = low == 0 ? 0 : low - pad; // zero stays the end of the axis
  axis.high = high == 0 ? 0 : high + pad;
}

// Ends on 1, 2 or 5 times a power of ten where the data span little, else on powers of ten.
double round_log(double value, bool up, bool whole_decades) {
  const double decade = std::pow(10., std::floor(std::log10(value) + 1e-9));
  double best = up ? 10 * decade : decade;
  if (value <= decade * (1 + 1e-9))
    return decade;
  if (!whole_decades)
    for (const double step : {2., 5.}) {
      const double candidate = step * decade;
      if (up ? candidate >= value * (1 - 1e-9) && candidate < best
             : candidate <= value * (1 + 1e-9) && candidate > best)
        best = candidate;
    }
  return best;
}

void set_log_range(ChartAxis& axis, double low, double high, bool padded) {
  const bool whole_decades = high > 300 * low;
  axis.low = round_log(low, false, whole_decades);
  axis.high = round_log(high, true, whole_decades);
  if (axis.low == axis.high)
    axis.high *= 10;
  // Points on the frame would be cut in half.
  const double pad = std::pow(axis.high / axis.low, 0.03);
  if (padded && low < axis.low * pad)
    axis.low /= pad;
  if (padded && high > axis.high / pad)
    axis.high *= pad;
}

std::string log_label(double tick) {
  const int exponent = static_cast<int>(std::floor(std::log10(tick) + 1e-9));
  const int digit = static_cast<int>(std::lround(tick / std::pow(10., exponent)));
  return digit == 1 ? power_of_ten(exponent) : std::to_string(digit) + "\u00b7" + power_of_ten(exponent);
}

void set_log_ticks(ChartAxis& axis) {
  const LogTicks marks = log_ticks(axis.low, axis.high);
  axis.major = marks.major;
  if (axis.high > 300 * axis.low) {
    axis.minor = marks.minor;
    for (const double tick : axis.major)
      axis.labels.push_back(log_label(tick));
    return;
  }
  // A short axis has labels at 1, 2 and 5, as plain numbers where these are short.
  for (const double tick : marks.minor) {
    const double lead = tick / std::pow(10., std::floor(std::log10(tick) + 1e-9));
    const bool labelled = std::abs(lead - 2) < 1e-6 || std::abs(lead - 5) < 1e-6;
    (labelled ? axis.major : axis.minor).push_back(tick);
  }
  for (const double end : {axis.low, axis.high}) { // log_ticks leaves out 2 and 5 when they are the very end
    const double lead = end / std::pow(10., std::floor(std::log10(end) + 1e-9));
    if (std::abs(lead - 2) < 1e-6 || std::abs(lead - 5) < 1e-6)
      axis.major.push_back(end);
  }
  std::sort(axis.major.begin(), axis.major.end());
  const bool plain = axis.low > 5e-4 && axis.high < 2e4;
  for (const double tick : axis.major)
    axis.labels.push_back(plain ? tick_labels({tick})[0] : log_label(tick));
}

} // namespace

bool ChartAxis::holds(double value) const {
  return std::isfinite(value) && (!log || value > 0);
}

double ChartAxis::place(double value) const {
  return log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

ChartAxis chart_axis(const std::vector<double>& values, bool log, bool padded, int ticks,
                     const std::optional<std::array<double, 2>>& range, const std::string& name,
                     const std::string& unit) {
  ChartAxis axis;
  axis.log = log;
  if (range) {
    const auto [low, high] = *range;
    if (!(std::isfinite(low) && std::isfinite(high) && low < high) || (log && !(low > 0)))
      throw geom::InputError(name, "{" + geom::text(low) + ", " + geom::text(high) + "}",
                             log ? "two numbers > 0, the lower one first"
                                 : "two numbers, the lower one first");
    axis.low = low;
    axis.high = high;
  } else {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double value : values)
      if (axis.holds(value)) {
        low = std::min(low, value);
        high = std::max(high, value);
      }
    if (!(low <= high)) { // nothing to show on this axis
      low = log ? 1 : 0;
      high = log ? 10 : 1;
    }
    if (log)
      set_log_range(axis, low, high, padded);
    else
      set_linear_range(axis, low, high, padded);
  }
  if (log) {
    set_log_ticks(axis);
    return axis;
  }
  // One power of ten for all labels where they would be long.
  const double largest = std::max(std::abs(axis.low), std::abs(axis.high));
  double factor = 1;
  if (takes_prefix(unit)) {
    const DisplayUnit shown = display_unit(unit, largest);
    factor = shown.factor;
    axis.unit = shown.text;
  } else if (largest >= 1e5 || largest < 2e-2) {
    const int exponent = 3 * static_cast<int>(std::floor(std::log10(largest) / 3 + 1e-9));
    factor = std::pow(10., -exponent);
    if (exponent != 0)
      axis.multiplier = "\u00d7" + power_of_ten(exponent);
  }
  std::vector<double> shown = round_ticks(axis.low * factor, axis.high * factor, ticks);
  if (!range && shown.size() > 1) { // reach for the next round number when it is near
    const double step = shown[1] - shown[0], reach = 0.03 * (axis.high - axis.low);
    if ((shown.back() + step) / factor - axis.high < reach)
      axis.high = (shown.back() + step) / factor;
    if (axis.low - (shown.front() - step) / factor < reach)
      axis.low = (shown.front() - step) / factor;
    shown = round_ticks(axis.low * factor, axis.high * factor, ticks);
  }
  axis.labels = tick_labels(shown);
  for (const double tick : shown)
    axis.major.push_back(tick / factor);
  return axis;
}

} // namespace cdem
