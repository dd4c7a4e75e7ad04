#include "libcdem/water/steady_wave.hpp"

#include "libcdem/water/wave_theories.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

namespace portable = geom::portable;
constexpr double two_pi = 6.283185307179586;

// cos and sin of theta, 2 theta, 3 theta ...
struct Harmonics {
  explicit Harmonics(double theta) : c1(portable::cos(theta)), s1(portable::sin(theta)) {}
  void next() {
    const double before = c;
    c = before * c1 - s * s1;
    s = s * c1 + before * s1;
  }
  double c1, s1, c = 1, s = 0;
};

void check_wave(const WaveGiven& w) {
  geom::require_positive("height", w.height);
  geom::require_positive("depth", w.depth);
  geom::require_positive("density", w.density, "kg/m3");
  geom::require_positive("gravity", w.gravity, "m/s2");
  if (w.period.has_value() == w.length.has_value())
    throw geom::InputError("period and length: give one of them");
  if (w.period)
    geom::require_positive("period", *w.period, "s");
  if (w.length)
    geom::require_positive("length", *w.length);
  if (w.order < 3 || w.order > 50)
    throw geom::InputError("order", std::to_string(w.order), "from 3 to 50");
  if (!(geom::Vec3(w.direction.x(), w.direction.y(), 0).norm() > 0))
    throw geom::InputError("direction", geom::text(w.direction), "a vector with a horizontal part");
}

// Angle in (-pi, pi], so that trigonometric functions see small numbers however long a run.
double small_angle(double theta) {
  return theta - two_pi * std::floor(theta / two_pi + 0.5);
}

} // namespace

double SteadyWave::length() const {
  return two_pi / wave_number;
}

SteadyWave::Surface SteadyWave::surface_at(double theta) const {
  Surface at{depth, 0};
  double k = 0;
  Harmonics h(theta);
  for (const double e : surface) {
    h.next();
    k += wave_number;
    at.height += e * h.c;
    at.slope -= k * e * h.s;
  }
  return at;
}

SteadyWave::Flow SteadyWave::flow(double theta, double z) const {
  Flow f;
  f.u = -mean;
  double ux = 0, uz = 0; // 1/s; wz = -ux, wx = uz
  Harmonics h(theta);
  // cosh(j k z) / cosh(j k d) = e^(jk(z-d)) (1 + e^(-2jkz)) / (1 + e^(-2jkd))
  const double rise = portable::exp(wave_number * (z - depth)), under = portable::exp(-2 * wave_number * z),
               bed = portable::exp(-2 * wave_number * depth);
  double r = 1, p = 1, q = 1, k = 0;
  for (const double b : potential) {
    h.next();
    r *= rise, p *= under, q *= bed, k += wave_number;
    const double scale = k * b * r / (1 + q), cosh = scale * (1 + p), sinh = scale * (1 - p);
    f.u += cosh * h.c;
    f.w += sinh * h.s;
    ux -= k * cosh * h.s;
    uz += k * sinh * h.c;
  }
  f.ax = f.u * ux + f.w * uz;
  f.az = f.u * uz - f.w * ux;
  return f;
}

double highest_wave(double l) {
  return (0.141063 * l + 0.0095721 * l * l + 0.0077829 * l * l * l) /
         (1 + 0.0788340 * l + 0.0317567 * l * l + 0.0093407 * l * l * l);
}

double linear_wave_number(double period, double depth, double gravity, double current) {
  const double omega = two_pi / period;
  const auto excess = [&](double k) {
    const double own = omega - k * current, e = portable::exp(-2 * k * depth);
    return gravity * k * (1 - e) / (1 + e) - (own > 0 ? own * own : 0);
  };
  double low = 0, high = omega * omega / gravity;
  // Against a current the excess is positive for some wave numbers only, and for none where the current stops the waves.
  while (excess(high) < 0) {
    high *= current < 0 ? 1.05 : 2;
    if (current < 0 && high > gravity / (current * current))
      throw geom::InputError("current", fmt::format("{:g}", current),
                             fmt::format("weaker against waves of {:g} s", period),
                             "these cannot travel against it");
  }
  for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

SteadyWave steady_wave(const WaveGiven& given) {
  check_wave(given);
  const double length =
      given.length ? *given.length
                   : two_pi / linear_wave_number(*given.period, given.depth, given.gravity, given.current);
  const double limit = highest_wave(length / given.depth) * given.depth;
  if (given.height > limit)
    throw geom::InputError("height", fmt::format("{:g}", given.height),
                           fmt::format("at most {:.4g} m, where a wave of {:.4g} m breaks in {:g} m of water",
                                       limit, length, given.depth),
                           "a lower or longer wave, or deeper water");
  switch (given.theory) {
  case WaveTheory::airy:
    return airy_wave(given);
  case WaveTheory::stokes:
    return stokes_wave(given);
  case WaveTheory::stream_function:
    break;
  }
  return stream_function_wave(given);
}

WaveField::WaveField(const WaveGiven& g) : given(g), wave(steady_wave(g)) {
  along = geom::Vec3(g.direction.x(), g.direction.y(), 0).normalized();
}

double WaveField::period() const {
  return wave.length() / (wave.mean + given.current);
}

WaterPoint WaveField::at(const geom::Vec3& place, double time) const {
  const double bed = given.level - wave.depth, c = wave.mean + given.current;
  const double theta = small_angle(wave.wave_number * ((place - given.crest_at).dot(along) - c * time));
  const auto [surface, slope] = wave.surface_at(theta);
  const double z = std::max(0.0, std::min(place.z() - bed, surface));
  const SteadyWave::Flow f = wave.flow(theta, z);
  WaterPoint point;
  point.velocity = (f.u + c) * along + f.w * geom::Vec3::UnitZ();
  point.acceleration = f.ax * along + f.az * geom::Vec3::UnitZ();
  point.surface = bed + surface;
  point.surface_slope = slope * along;
  point.pressure_gradient =
      given.density * (-given.gravity * geom::Vec3::UnitZ() - point.acceleration); // Euler's equation
  if (place.z() <= point.surface)
    point.pressure = given.density * std::max(0.0, wave.bernoulli - given.gravity * (place.z() - bed) -
                                                       0.5 * (f.u * f.u + f.w * f.w));
  return point;
}

} // namespace cdem
