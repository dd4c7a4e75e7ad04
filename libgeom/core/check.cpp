#include "libgeom/core/check.hpp"

#include "libgeom/core/error.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace geom {

std::string text(double value) {
  if (!std::isfinite(value))
    return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return std::string(buffer, end);
}

std::string text(const Vec3& value) {
  return "{" + text(value.x()) + ", " + text(value.y()) + ", " + text(value.z()) + "}";
}

std::string shown(const Vec3& x) {
  char text[64];
  std::snprintf(text, sizeof text, "(%g, %g, %g)", x.x(), x.y(), x.z());
  return text;
}

void require_finite(const std::string& field, const Vec3& value) {
  if (!value.allFinite())
    throw InputError(field, text(value), "three finite numbers");
}

void require_positive(const std::string& field, double value, const std::string& unit) {
  if (!(std::isfinite(value) && value > 0))
    throw InputError(field, text(value), "finite and > 0" + (unit.empty() ? unit : " " + unit));
}

void require_positive(const std::string& field, const Vec3& value) {
  if (!(value.allFinite() && (value.array() > 0).all()))
    throw InputError(field, text(value), "three finite lengths > 0 m");
}

void require_between(const std::string& field, double value, double low, double high,
                     const std::string& unit) {
  if (!(value >= low && value <= high))
    throw InputError(field, text(value),
                     "from " + text(low) + " to " + text(high) + (unit.empty() ? unit : " " + unit));
}

void require(bool holds, const std::string& field, double value, const std::string& allowed,
             const std::string& advice) {
  if (holds)
    return;
  char shown[32];
  std::snprintf(shown, sizeof shown, "%g", value);
  throw InputError(field, shown, allowed, advice);
}

void require_above(const std::string& field, double value, double low, const std::string& unit,
                   const std::string& advice) {
  require(std::isfinite(value) && value > low, field, value,
          "a finite number > " + text(low) + (unit.empty() ? unit : " " + unit), advice);
}

void require_at_least(const std::string& field, double value, double low, const std::string& unit,
                      const std::string& advice) {
  require(std::isfinite(value) && value >= low, field, value,
          "a finite number >= " + text(low) + (unit.empty() ? unit : " " + unit), advice);
}

void require_in(const std::string& field, double value, const std::string& range, const std::string& advice) {
  const auto number_at = [&](std::size_t begin) {
    double number = 0;
    std::from_chars(range.data() + begin, range.data() + range.size(), number);
    return number;
  };
  const double low = number_at(1), high = number_at(range.find(',') + 2);
  require((range.front() == '(' ? value > low : value >= low) &&
              (range.back() == ')' ? value < high : value <= high),
          field, value, "in " + range, advice);
}

void require_block_count(const std::string& field, const std::string& value, double blocks,
                         const std::string& advice) {
  if (!(blocks <= max_blocks)) {
    char count[32];
    std::snprintf(count, sizeof count, "%.3g", blocks);
    throw InputError(field, value,
                     std::string("such that there are at most 10 million blocks (this asks for about ") +
                         count + ")",
                     advice);
  }
}

} // namespace geom
