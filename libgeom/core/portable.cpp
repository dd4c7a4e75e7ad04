#include "libgeom/core/portable.hpp"

#include "libgeom/core/exp_series.hpp"

#include <cmath>
#include <limits>

namespace geom::portable {
namespace {

// Sum of c[i] t^i, from the highest power down.
template <int n>
double polynomial(const double (&c)[n], double t) {
  double sum = c[n - 1];
  for (int i = n - 2; i >= 0; --i)
    sum = sum * t + c[i];
  return sum;
}

// pi/2 = half_pi + half_pi_rest. For the reduction in three parts, of which the first two have so few digits that k
// times either is exact for |k| < 2^20.
constexpr double half_pi = 0x1.921fb54442d18p+0, half_pi_rest = 0x1.1a62633145c07p-54;
constexpr double part1 = 0x1.921fb54400000p+0, part2 = 0x1.0b4611a600000p-34, part3 = 0x1.3198a2e037073p-69;

// x = quarter pi/2 + rest, |rest| <= pi/4.
struct Reduced {
  double rest = 0;
  int quarter = 0; // modulo 4
};

Reduced reduced(double x) {
  if (!std::isfinite(x))
    return {std::numeric_limits<double>::quiet_NaN(), 0};
  if (!(std::abs(x) < 0x1p20)) // beyond that the argument itself is uncertain by more than the sine keeps
    x = std::remainder(x, 4 * half_pi);
  const double k = std::nearbyint(x / half_pi);
  return {((x - k * part1) - k * part2) - k * part3, static_cast<int>(static_cast<long long>(k) & 3)};
}

// Taylor's series: the first term left out is below 1e-18 of the sum at pi/4.
double sine(double r) {
  constexpr double c[] = {-1 / 6.,        1 / 120.,        -1 / 5040.,          1 / 362880.,
                          -1 / 39916800., 1 / 6227020800., -1 / 1307674368000., 1 / 355687428096000.};
  const double r2 = r * r;
  return r + r * (r2 * polynomial(c, r2));
}

double cosine(double r) {
  constexpr double c[] = {1 / 24.,        -1 / 720.,         1 / 40320.,          -1 / 3628800.,
                          1 / 479001600., -1 / 87178291200., 1 / 20922789888000., -1 / 6402373705728000.};
  const double r2 = r * r, half = 0.5 * r2, most = 1 - half;
  return most + (((1 - most) - half) + r2 * r2 * polynomial(c, r2)); // the digits that 1 - half has lost
}

// Angle whose tangent is t, in [0, 1]: that of the nearest quarter c, and that of (t - c) / (1 + t c) by its series.
double arc_tangent(double t) {
  constexpr double at_quarters[] = {0, 0x1.f5b75f92c80ddp-3, 0x1.dac670561bb4fp-2, 0x1.4978fa3269ee1p-1,
                                    0x1.921fb54442d18p-1};
  constexpr double rest[] = {0, 0x1.8ab6e3cf7afbdp-57, 0x1.a2b7f222f65e2p-56, 0x1.2419a87f2a458p-56,
                             0x1.1a62633145c07p-55};
  constexpr double c[] = {-1 / 3., 1 / 5., -1 / 7., 1 / 9., -1 / 11., 1 / 13., -1 / 15., 1 / 17.};
  const auto quarter = std::lround(4 * t);
  const double at = 0.25 * static_cast<double>(quarter), d = quarter == 0 ? t : (t - at) / (1 + t * at),
               d2 = d * d;
  return at_quarters[quarter] + (d + (d * (d2 * polynomial(c, d2)) + rest[quarter]));
}

} // namespace

double exp(double x) {
  if (!(x > -745.2)) // not a number too
    return x == x ? 0 : x;
  if (x > 709.8)
    return std::numeric_limits<double>::infinity();
  const double k = std::nearbyint(x / ln2);
  return std::ldexp(exp_over_power(x, k), static_cast<int>(k));
}

// ln(x) for x > 0 from ln((1 + s) / (1 - s)) = 2 (s + s^3/3 + ...).
double log(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent); // exact
  if (m < 0.70710678118654752) {
    m *= 2;
    --exponent;
  }
  const double s = (m - 1) / (m + 1), s2 = s * s; // s2 < 0.0295
  double sum = 0;
  for (int k = 23; k >= 1; k -= 2)
    sum = sum * s2 + 1.0 / k;
  return exponent * 0.69314718055994531 + 2 * s * sum;
}

double sin(double angle) {
  const Reduced a = reduced(angle);
  const double s = (a.quarter & 1) != 0 ? cosine(a.rest) : sine(a.rest);
  return (a.quarter & 2) != 0 ? -s : s;
}

double cos(double angle) {
  const Reduced a = reduced(angle);
  const double c = (a.quarter & 1) != 0 ? sine(a.rest) : cosine(a.rest);
  return ((a.quarter + 1) & 2) != 0 ? -c : c;
}

double tan(double angle) {
  return sin(angle) / cos(angle);
}

double atan2(double y, double x) {
  const double across = std::abs(y), along = std::abs(x);
  if (across != across || along != along)
    return across + along;
  const bool back = std::signbit(x);
  double angle = back ? 2 * half_pi : 0;
  if (across <= along && along > 0) {
    const double a = arc_tangent(std::isinf(across) ? 1 : across / along);
    angle = back ? 2 * half_pi - (a - 2 * half_pi_rest) : a;
  } else if (across > 0) {
    const double a = arc_tangent(along / across);
    angle = back ? half_pi + (a + half_pi_rest) : half_pi - (a - half_pi_rest);
  }
  return std::copysign(angle, y);
}

double acos(double x) {
  return 2 * atan2(std::sqrt(1 - x), std::sqrt(1 + x));
}

} // namespace geom::portable
