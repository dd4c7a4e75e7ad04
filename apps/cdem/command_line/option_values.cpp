#include "apps/cdem/command_line/option_values.hpp"

#include "libcdem/vtk/picture.hpp"

#include "apps/cdem/process/failure.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>

namespace cdem::app {

namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& allowed) {
  throw UsageError(option + " = " + (text.empty() ? "\"\"" : text) + ": must be " + allowed);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

std::pair<std::string, std::string> setting(const std::string& text, const std::string& form) {
  const auto equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
    throw UsageError("--set " + text + ": must be " + form);
  return {text.substr(0, equals), text.substr(equals + 1)};
}

} // namespace

int whole_number(const std::string& option, const std::string& text, int low, int high) {
  char* end = nullptr;
  errno = 0;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || errno != 0 || value < low || value > high)
    refuse(option, text, "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  return static_cast<int>(value);
}

double real_number(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
    refuse(option, text, "a finite number");
  return value;
}

std::map<std::string, std::string> settings_of(const std::vector<std::string>& texts) {
  std::map<std::string, std::string> settings;
  for (const auto& text : texts)
    if (const auto [name, value] = setting(text, "name=value, e.g. --set pressure=24e6");
        !settings.emplace(name, value).second)
      throw UsageError("--set " + name + " is given twice");
  return settings;
}

std::vector<std::map<std::string, std::string>> combinations_of(const std::vector<std::string>& texts) {
  const std::string form = "name=value,value,..., e.g. --set pressure=24e6,30e6";
  std::vector<std::map<std::string, std::string>> combinations(1);
  constexpr std::size_t most = 100000;
  for (const auto& text : texts) {
    const auto [name, list] = setting(text, form);
    if (combinations.front().count(name) > 0)
      throw UsageError("--set " + name + " is given twice");
    const auto values = split(list, ',');
    if (combinations.size() * values.size() > most)
      throw UsageError("--set asks for more than " + std::to_string(most) + " runs");
    std::vector<std::map<std::string, std::string>> longer;
    for (const auto& combination : combinations)
      for (const auto& value : values) {
        if (value.empty())
          throw UsageError("--set " + text + ": must be " + form);
        longer.push_back(combination);
        longer.back()[name] = value;
      }
    combinations = std::move(longer);
  }
  return combinations;
}

std::array<int, 2> size_value(const std::string& option, const std::string& text) {
  const auto parts = split(text, 'x');
  if (parts.size() > 2 || parts[0].empty() || parts.back().empty())
    refuse(option, text, "WIDTHxHEIGHT or WIDTH in pixels, e.g. 1600x1200");
  const auto side = [&](const std::string& part) {
    return whole_number(option, part, least_picture_side, most_picture_side);
  };
  return {side(parts[0]), parts.size() == 2 ? side(parts[1]) : 0};
}

std::vector<std::string> names_value(const std::string& option, const std::string& text) {
  std::vector<std::string> names = split(text, ',');
  if (std::any_of(names.begin(), names.end(), [](const std::string& name) { return name.empty(); }))
    refuse(option, text, "NAME,..., with a name or number between any two commas");
  return names;
}

std::array<double, 2> range_value(const std::string& option, const std::string& text) {
  const auto parts = split(text, ',');
  if (parts.size() != 2)
    refuse(option, text, "LOW,HIGH, e.g. -1e-3,1e-3");
  const std::array<double, 2> range = {real_number(option, parts[0]), real_number(option, parts[1])};
  if (range[0] >= range[1])
    refuse(option, text, "LOW,HIGH with LOW below HIGH");
  return range;
}

} // namespace cdem::app
