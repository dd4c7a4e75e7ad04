// Numbers as a reader wants them: a unit prefix that keeps them short, round ticks, proper minus signs.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace cdem {

struct DisplayUnit {
  double factor = 1; // shown value = factor * SI value
  std::string text;  // "mm", "MPa", "10^{-3}", empty for a plain number
};

// The largest prefix with which `largest` (SI, >= 0) is at least 0.1 (1 for giga); powers of ten for units
// without prefixes.
DisplayUnit display_unit(const std::string& unit, double largest);

bool takes_prefix(const std::string& unit); // "Pa", "m": kPa and mm are units too

// "opening (m)": "m"; empty when the label ends otherwise. with_unit: the label with another unit there.
std::string unit_of_label(const std::string& label);
std::string with_unit(const std::string& label, const std::string& unit);

// Ticks at 1, 2, 2.5 or 5 times a power of ten inside [low, high], about `count` of them.
std::vector<double> round_ticks(double low, double high, int count);

// All labels with the same number of decimals, as many as their spacing needs.
std::vector<std::string> tick_labels(const std::vector<double>& ticks);

struct LogTicks {
  std::vector<double> major, minor; // powers of ten that carry labels; the ticks between
};
LogTicks log_ticks(double low, double high);

std::string power_of_ten(int exponent); // "10^{-3}"

// The names of `known` nearest to `name` by edit distance, best first, at most three; empty when none is
// near.
std::vector<std::string> nearest_names(const std::string& name, const std::vector<std::string>& known);

} // namespace cdem
