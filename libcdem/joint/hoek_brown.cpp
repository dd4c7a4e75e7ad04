#include "libcdem/joint/hoek_brown.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cdem {
namespace {

// After which an interval is as short as rounding.
constexpr int halvings = 60;

double power(double x, double exponent) {
  return x > 0 ? geom::portable::exp(exponent * geom::portable::log(x)) : 0;
}

} // namespace

void validate(const RockMass& rock) {
  geom::require_above("sigma_ci", rock.sigma_ci, 0, "Pa",
                      "the uniaxial compressive strength of the intact rock");
  geom::require_in("gsi", rock.geological_strength, "[5, 100]",
                   "the geological strength index; 100 is intact rock");
  geom::require_above("m_i", rock.intact_constant, 0, "", "4 for claystone to 33 for granite");
  geom::require_in("disturbance", rock.disturbance, "[0, 1]", "D: 0 is undisturbed rock, 1 poor blasting");
}

HoekBrown hoek_brown(const RockMass& rock) {
  using geom::portable::exp;
  const double gsi = rock.geological_strength, d = rock.disturbance;
  HoekBrown law;
  law.sigma_ci = rock.sigma_ci;
  law.m_b = rock.intact_constant * exp((gsi - 100) / (28 - 14 * d));
  law.s = exp((gsi - 100) / (9 - 3 * d));
  law.a = 0.5 + (exp(-gsi / 15) - exp(-20.0 / 3)) / 6;
  return law;
}

double strength(const HoekBrown& law, double p3) {
  return p3 + law.sigma_ci * power(law.m_b * p3 / law.sigma_ci + law.s, law.a);
}

double uniaxial_tensile_strength(const HoekBrown& law) {
  double low = 0, high = law.s * law.sigma_ci / law.m_b; // where p1 = p3
  for (int i = 0; i < halvings; ++i) {
    const double t = 0.5 * (low + high);
    (strength(law, -t) > 0 ? low : high) = t;
  }
  return low;
}

double slope(const HoekBrown& law, double p3) {
  return 1 + law.a * law.m_b * power(law.m_b * p3 / law.sigma_ci + law.s, law.a - 1);
}

StraightStrength straight_strength(double q, double n) {
  StraightStrength line;
  line.sin_friction = (n - 1) / (n + 1);
  line.cos_friction = 2 * std::sqrt(n) / (n + 1);
  line.cohesion = q / (2 * std::sqrt(n));
  return line;
}

StraightStrength tangent(const HoekBrown& law, double p3) {
  const double at = std::max(p3, -uniaxial_tensile_strength(law));
  const double n = slope(law, at);
  return straight_strength(strength(law, at) - n * at, n);
}

StraightStrength tangent_on_plane(const HoekBrown& law, double pressure) {
  double low = -uniaxial_tensile_strength(law),
         high = std::max(low, pressure); // the plane's pressure is at least p3
  for (int i = 0; i < halvings && low < high; ++i) {
    const double p3 = 0.5 * (low + high);
    const double there = p3 + (strength(law, p3) - p3) / (slope(law, p3) + 1);
    (there < pressure ? low : high) = p3;
  }
  return tangent(law, low);
}

void require_straight(const HoekBrown& law) {
  if (law.on())
    throw geom::InputError(
        "reduce", "a Hoek-Brown strength", "a Mohr-Coulomb strength",
        "a factor divides cohesion and tan(friction angle), which Hoek-Brown does not have; give "
        "those of the tangent to the curve at the pressures of the model");
}

std::vector<StraightStrength> chords(const HoekBrown& law) {
  const double t = -uniaxial_tensile_strength(law);
  const std::array<double, 6> p{
      t, 0, 0.05 * law.sigma_ci, 0.2 * law.sigma_ci, 0.6 * law.sigma_ci, 2 * law.sigma_ci};
  std::vector<StraightStrength> all;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const double n = (strength(law, p[i + 1]) - strength(law, p[i])) / (p[i + 1] - p[i]);
    all.push_back(straight_strength(strength(law, p[i]) - n * p[i], n));
  }
  // Beyond the last, p1 - p3 does not fall.
  all.push_back(straight_strength(strength(law, p.back()) - p.back(), 1));
  return all;
}

} // namespace cdem
