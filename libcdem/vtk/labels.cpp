#include "libcdem/vtk/labels.hpp"

#include "libgeom/core/nearest.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace cdem {
namespace {

struct Prefix {
  const char* text;
  double factor;
};
constexpr std::array<Prefix, 7> prefixes = {
    {{"G", 1e9}, {"M", 1e6}, {"k", 1e3}, {"", 1}, {"m", 1e-3}, {"\u00b5", 1e-6}, {"n", 1e-9}}};

bool stops_at_one(const std::string& unit) {
  return unit[0] == 'm' || unit == "s";
}

std::string with_exponents(const std::string& unit) { // "m/s2" -> "m/s²"
  std::string text;
  for (const char c : unit)
    text += c == '2' ? "\u00b2" : c == '3' ? "\u00b3" : std::string(1, c);
  return text;
}

} // namespace

// Only units whose prefix multiplies the whole unit: mm2 is not 1e-3 m2. Lengths and times stop at m and s.
bool takes_prefix(const std::string& unit) {
  static const std::vector<std::string> units = {"m", "m/s", "m/s2", "s",   "Pa",   "N",
                                                 "J", "W",   "Hz",   "N/m", "Pa/m", "Pa/s"};
  return std::find(units.begin(), units.end(), unit) != units.end();
}

std::string unit_of_label(const std::string& label) {
  const auto open = label.rfind('(');
  return open == std::string::npos || label.back() != ')' ? std::string()
                                                          : label.substr(open + 1, label.size() - open - 2);
}

std::string with_unit(const std::string& label, const std::string& unit) {
  return label.substr(0, label.rfind('(')) + "(" + unit + ")";
}

std::string power_of_ten(int exponent) {
  return "10^{" + std::string(exponent < 0 ? "\u2212" : "") + std::to_string(std::abs(exponent)) + "}";
}

DisplayUnit display_unit(const std::string& unit, double largest) {
  const bool plain = unit.empty() || unit == "1";
  if (!(largest > 0) || !std::isfinite(largest))
    return {1, plain ? std::string() : with_exponents(unit)};
  if (takes_prefix(unit)) {
    for (const Prefix& prefix : prefixes) {
      const bool allowed = !(prefix.factor > 1 && stops_at_one(unit));
      const double least = prefix.factor > 1e6 ? 1 : 0.1; // 110 MPa reads better than 0.11 GPa
      if (allowed && largest >= least * prefix.factor)
        return {1 / prefix.factor, prefix.text + with_exponents(unit)};
    }
  }
  // The range 0.01 .. 10^4 reads well as it stands.
  if (largest >= 1e-2 && largest < 1e4)
    return {1, plain ? std::string() : with_exponents(unit)};
  const int exponent = 3 * static_cast<int>(std::floor(std::log10(largest * (1 + 1e-12)) / 3));
  return {std::pow(10., -exponent), power_of_ten(exponent) + (plain ? "" : " " + with_exponents(unit))};
}

std::vector<double> round_ticks(double low, double high, int count) {
  const double span = high - low;
  if (!(span > 0) || !std::isfinite(span) || count < 1)
    return {low};
  const double rough = span / count;
  const double decade = std::pow(10., std::floor(std::log10(rough)));
  double step = 10 * decade;
  for (const double candidate : {1., 2., 2.5, 5.})
    if (candidate * decade >= rough * (1 - 1e-9)) {
      step = candidate * decade;
      break;
    }
  std::vector<double> ticks;
  const double slack = 1e-9 * span;
  for (double k = std::ceil((low - slack) / step); k * step <= high + slack; k += 1)
    ticks.push_back(k == 0 ? 0. : k * step); // never -0
  return ticks;
}

std::vector<std::string> tick_labels(const std::vector<double>& ticks) {
  double largest = 0;
  for (const double tick : ticks)
    largest = std::max(largest, std::abs(tick));
  int decimals = 0;
  // The fewest decimals that print every tick exactly, up to six.
  const auto exact = [&](double tick) {
    const double scaled = tick * std::pow(10., decimals);
    return std::abs(scaled - std::round(scaled)) <= 1e-6;
  };
  while (decimals < 6 && !std::all_of(ticks.begin(), ticks.end(), exact))
    ++decimals;
  std::vector<std::string> labels;
  for (const double tick : ticks) {
    char text[64];
    if (largest >= 1e7)
      std::snprintf(text, sizeof text, "%.4g", std::abs(tick));
    else
      std::snprintf(text, sizeof text, "%.*f", decimals, std::abs(tick));
    labels.push_back((tick < 0 ? "\u2212" : "") + std::string(text));
  }
  return labels;
}

LogTicks log_ticks(double low, double high) {
  LogTicks ticks;
  const int first = static_cast<int>(std::floor(std::log10(low) + 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(high) - 1e-9));
  const int stride = std::max(1, (last - first + 7) / 8); // at most eight or so labels
  for (int exponent = first; exponent <= last; ++exponent) {
    const double decade = std::pow(10., exponent);
    const bool inside = decade >= low * (1 - 1e-9) && decade <= high * (1 + 1e-9);
    if (inside)
      ((exponent - first) % stride == 0 ? ticks.major : ticks.minor).push_back(decade);
    if (stride == 1)
      for (int k = 2; k < 10; ++k)
        if (k * decade > low && k * decade < high)
          ticks.minor.push_back(k * decade);
  }
  return ticks;
}

std::vector<std::string> nearest_names(const std::string& name, const std::vector<std::string>& known) {
  std::vector<std::pair<int, std::string>> near;
  for (const std::string& candidate : known) {
    const bool contains = name.size() >= 3 && candidate.find(name) != std::string::npos;
    const int distance = contains ? 1 : geom::edit_distance(name, candidate);
    if (distance <= std::max<int>(2, static_cast<int>(name.size()) / 3))
      near.emplace_back(distance, candidate);
  }
  std::stable_sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (std::size_t i = 0; i < near.size() && i < 3; ++i)
    names.push_back(near[i].second);
  return names;
}

} // namespace cdem
