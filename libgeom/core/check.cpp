#include "libgeom/core/check.hpp"

#include "libgeom/core/error.hpp"

#include <charconv>
#include <cmath>

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
