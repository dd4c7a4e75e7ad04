// Degrees in scripts, radians inside.
#pragma once

namespace cdem::script {

inline constexpr double pi = 3.14159265358979323846;
constexpr double radians(double degrees) {
  return degrees * pi / 180;
}
constexpr double degrees(double radians) {
  return radians * 180 / pi;
}

} // namespace cdem::script
