#include "libcdem/water/wave_theories.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

constexpr double full_turn = 6.283185307179586;

struct Hyperbolic {
  explicit Hyperbolic(double kd) {
    const double e = geom::portable::exp(-2 * kd);
    tanh = (1 - e) / (1 + e);
    sinh = (1 - e) / (2 * geom::portable::exp(-kd));
    cosh = (1 + e) / (2 * geom::portable::exp(-kd));
    s = 2 * e / (1 + e * e); // sech 2kd
  }
  double tanh, sinh, cosh, s;
};

// Fenton's table; his U is the mean speed of the water in the frame of the crest.
struct Stokes5 {
  Stokes5(double kd, double eps) {
    const Hyperbolic h(kd);
    const double s = h.s, coth = 1 / h.tanh, c0 = std::sqrt(h.tanh);
    const auto poly = [s](std::initializer_list<double> c) {
      double sum = 0, power = 1;
      for (const double x : c) {
        sum += x * power;
        power *= s;
      }
      return sum;
    };
    const double m = 1 - s, m2 = m * m, m3 = m2 * m, m4 = m2 * m2, m5 = m4 * m, m6 = m3 * m3;
    const double p = 3 + 2 * s, q = 4 + s;
    const double a11 = 1 / h.sinh, a22 = 3 * s * s / (2 * m2);
    const double a31 = poly({-4, -20, 10, -13}) / (8 * h.sinh * m3);
    const double a33 = poly({0, 0, -2, 11}) / (8 * h.sinh * m3);
    const double a42 = poly({0, 12, -14, -264, -45, -13}) / (24 * m5);
    const double a44 = poly({0, 0, 0, 10, -174, 291, 278}) / (48 * p * m5);
    const double a51 =
        poly({-1184, 32, 13232, 21712, 20940, 12554, -500, -3341, -670}) / (64 * h.sinh * p * q * m6);
    const double a53 = poly({0, 4, 105, 198, -1376, -1302, -117, 58}) / (32 * h.sinh * p * m6);
    const double a55 = poly({0, 0, 0, -6, 272, -1552, 852, 2029, 430}) / (64 * h.sinh * p * q * m6);
    const double b22 = coth * poly({1, 2}) / (2 * m), b31 = -3 * poly({1, 3, 3, 2}) / (8 * m3);
    const double b42 = coth * poly({6, -26, -182, -204, -25, 26}) / (6 * p * m4);
    const double b44 = coth * poly({24, 92, 122, 66, 67, 34}) / (24 * p * m4);
    const double b53 = 9 * poly({132, 17, -2216, -5897, -6292, -2687, 194, 467, 82}) / (128 * p * q * m6);
    const double b55 = 5 * poly({300, 1579, 3176, 2949, 1188, 675, 1326, 827, 130}) / (384 * p * q * m6);
    const double c2 = c0 * poly({2, 0, 7}) / (4 * m2),
                 c4 = c0 * poly({4, 32, -116, -400, -71, 146}) / (32 * m5);
    const double e2 = h.tanh * poly({2, 2, 5}) / (4 * m2);
    const double e4 = h.tanh * poly({8, 12, -152, -308, -42, 77}) / (32 * m5);
    const double x = eps, x2 = x * x, x3 = x2 * x, x4 = x2 * x2, x5 = x4 * x;
    surface = {x + x3 * b31 - x5 * (b53 + b55), x2 * b22 + x4 * b42, -x3 * b31 + x5 * b53, x4 * b44,
               x5 * b55};
    potential = {x * a11 + x3 * a31 + x5 * a51, x2 * a22 + x4 * a42, x3 * a33 + x5 * a53, x4 * a44, x5 * a55};
    for (double& b : potential)
      b *= c0;
    mean = c0 + x2 * c2 + x4 * c4;
    bernoulli = 0.5 * c0 * c0 + kd + x2 * e2 + x4 * e4;
  }
  std::array<double, 5> surface, potential; // k eta, potential sqrt(k^3 / g)
  double mean, bernoulli;                   // U sqrt(k / g), R k / g
};

double cosh_of(double x) {
  return 0.5 * (geom::portable::exp(x) + geom::portable::exp(-x));
}

// k at which a wave of the given period and height has it.
double stokes_wave_number(const WaveGiven& g) {
  if (g.length)
    return full_turn / *g.length;
  const auto excess = [&](double k) { // k c - omega
    const Stokes5 w(k * g.depth, 0.5 * k * g.height);
    return k * (w.mean * std::sqrt(g.gravity / k) + g.current) - full_turn / *g.period;
  };
  double high = linear_wave_number(*g.period, g.depth, g.gravity, g.current), low = 0.5 * high;
  while (excess(high) < 0)
    high *= 1.1;
  for (int i = 0; i < 100 && high - low > 1e-15 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace

SteadyWave airy_wave(const WaveGiven& g) {
  SteadyWave wave;
  wave.wave_number =
      g.length ? full_turn / *g.length : linear_wave_number(*g.period, g.depth, g.gravity, g.current);
  wave.depth = g.depth;
  wave.gravity = g.gravity;
  const Hyperbolic h(wave.wave_number * g.depth);
  wave.mean = std::sqrt(g.gravity / wave.wave_number * h.tanh);
  wave.bernoulli = 0.5 * wave.mean * wave.mean + g.gravity * g.depth;
  wave.surface = {0.5 * g.height};
  wave.potential = {0.5 * g.height * g.gravity / (wave.mean * wave.wave_number)};
  return wave;
}

SteadyWave stokes_wave(const WaveGiven& g) {
  SteadyWave wave;
  const double k = stokes_wave_number(g), length = full_turn / k;
  if (const double ursell = g.height * length * length / (g.depth * g.depth * g.depth); ursell > 40)
    throw geom::InputError("theory: \"stokes\": H L^2 / d^3 = " + fmt::format("{:.3g}", ursell) +
                           " is above 40: the wave is too long for it; take \"stream_function\"");
  const Stokes5 w(k * g.depth, 0.5 * k * g.height);
  wave.wave_number = k;
  wave.depth = g.depth;
  wave.gravity = g.gravity;
  wave.mean = w.mean * std::sqrt(g.gravity / k);
  wave.bernoulli = w.bernoulli * g.gravity / k;
  for (int j = 0; j < 5; ++j) {
    wave.surface.push_back(w.surface[j] / k);
    wave.potential.push_back(w.potential[j] * std::sqrt(g.gravity / (k * k * k)) *
                             cosh_of((j + 1) * k * g.depth));
  }
  return wave;
}

} // namespace cdem
