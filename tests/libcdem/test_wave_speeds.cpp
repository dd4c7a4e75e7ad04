// Speeds of elastic waves against closed forms, and Rayleigh's equation itself.
#include "libcdem/material/wave_speeds.hpp"

#include <catch2/catch.hpp>

#include <cmath>

namespace {

cdem::Elastic solid(double poissons_ratio) {
  cdem::Elastic m;
  m.youngs_modulus = 30e9;
  m.poissons_ratio = poissons_ratio;
  m.density = 2400;
  return m;
}

} // namespace

TEST_CASE("the Rayleigh speed has its closed forms at Poisson's ratios of 0 and 1/4", "[waves]") {
  const auto over_shear = [](double poissons_ratio) {
    const cdem::Elastic m = solid(poissons_ratio);
    return cdem::rayleigh_speed(m) / cdem::shear_speed(m);
  };
  CHECK(over_shear(0) == Approx(std::sqrt(3 - std::sqrt(5.0))).epsilon(1e-14));
  CHECK(over_shear(0.25) == Approx(std::sqrt(2 - 2 / std::sqrt(3.0))).epsilon(1e-14));
}

TEST_CASE("the Rayleigh speed solves Rayleigh's equation for every Poisson's ratio", "[waves]") {
  const double nu = GENERATE(-0.5, -0.1, 0.05, 0.1, 0.2, 0.3, 0.4, 0.45, 0.499);
  const cdem::Elastic m = solid(nu);
  const double c = cdem::rayleigh_speed(m), s = c / cdem::shear_speed(m), d = c / cdem::dilatational_speed(m);
  const double left = (2 - s * s) * (2 - s * s), right = 4 * std::sqrt((1 - d * d) * (1 - s * s));
  CHECK(s < 1);
  CHECK(left == Approx(right).epsilon(1e-12));
}
