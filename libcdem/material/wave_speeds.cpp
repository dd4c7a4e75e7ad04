#include "libcdem/material/wave_speeds.hpp"

#include <cmath>

namespace cdem {

double dilatational_speed(const Elastic& material) {
  return std::sqrt(material.p_wave_modulus() / material.density);
}

double shear_speed(const Elastic& material) {
  return std::sqrt(material.shear_modulus() / material.density);
}

double rayleigh_speed(const Elastic& material) {
  // Squared and divided by x = (c / c_s)^2 the equation is the cubic x^3 - 8 x^2 + 8 (3 - 2 k) x - 16 (1 - k) = 0, with
  // k = (c_s / c_d)^2. It is negative at 0 and 1 at 1, and has one root between them. Halving keeps to that root,
  // which a formula for cubics would have to be told apart from the others.
  const double k = material.shear_modulus() / material.p_wave_modulus();
  double low = 0, high = 1;
  for (double x = 0.5; low < x && x < high; x = 0.5 * (low + high))
    (((x - 8) * x + 8 * (3 - 2 * k)) * x - 16 * (1 - k) < 0 ? low : high) = x;
  return std::sqrt(0.5 * (low + high)) * shear_speed(material);
}

} // namespace cdem
