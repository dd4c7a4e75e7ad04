// One axis of a chart: its range, ticks and labels, and where a value lies on it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace cdem {

struct ChartAxis {
  bool log = false;
  double low = 0, high = 1;
  std::vector<double> major, minor;
  std::vector<std::string> labels; // one for each major tick
  std::string multiplier;          // "\u00d710^{3}" of all labels, or empty
  std::string unit; // of the labels, with its prefix: "mm"; empty when the unit given was not changed

  bool holds(double value) const;   // can be drawn: finite, and positive on a log axis
  double place(double value) const; // 0 at low, 1 at high
};

// `padded`: a linear range ends a little beyond the data. `ticks`: about how many on a linear axis.
// `unit` of the values: one that takes SI prefixes gets that which keeps a linear axis's labels short.
// Throws geom::InputError when `range` is empty, or not positive on a log axis; `name` is the field it came
// from.
ChartAxis chart_axis(const std::vector<double>& values, bool log, bool padded, int ticks,
                     const std::optional<std::array<double, 2>>& range, const std::string& name,
                     const std::string& unit = "");

} // namespace cdem
