#include "libcdem/water/irregular_sea.hpp"

#include "libcdem/water/steady_wave.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/core/random.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

namespace exact = geom::portable;
constexpr double circle = 6.283185307179586;

double spectrum(double f, double peak, double gamma) { // f and peak in Hz; up to a factor
  const double ratio = peak / f, width = f <= peak ? 0.07 : 0.09, off = (f / peak - 1) / width;
  return exact::exp(-5 * exact::log(f / peak) - 1.25 * ratio * ratio * ratio * ratio +
                    exact::exp(-0.5 * off * off) * exact::log(gamma));
}

double turned(double angle) { // in (-pi, pi]
  return angle - circle * std::floor(angle / circle + 0.5);
}

} // namespace

IrregularSea::IrregularSea(const SeaGiven& g) : given_(g) {
  geom::require_positive("significant_height", g.significant_height);
  geom::require_positive("peak_period", g.peak_period, "s");
  geom::require_positive("depth", g.depth);
  geom::require_positive("density", g.density, "kg/m3");
  geom::require_positive("gravity", g.gravity, "m/s2");
  geom::require_between("peak_enhancement", g.peak_enhancement, 1, 20);
  if (g.components < 10 || g.components > 10000)
    throw geom::InputError("components", std::to_string(g.components), "from 10 to 10000");
  along_ = geom::Vec3(g.direction.x(), g.direction.y(), 0);
  if (!(along_.norm() > 0))
    throw geom::InputError("direction", geom::text(g.direction), "a vector with a horizontal part");
  along_.normalize();
  // Waves in shallow water are no higher than some 0.6 d in the mean of the highest third.
  if (g.significant_height > 0.6 * g.depth)
    throw geom::InputError("significant_height", fmt::format("{:g}", g.significant_height),
                           fmt::format("at most 0.6 of the depth, {:.4g} m", 0.6 * g.depth),
                           "waves beyond break before they arrive");
  const double length = circle / linear_wave_number(g.peak_period, g.depth, g.gravity);
  if (g.significant_height > length / 15)
    throw geom::InputError(
        "significant_height", fmt::format("{:g}", g.significant_height),
        fmt::format("at most a fifteenth of the length at the peak, {:.4g} m", length / 15),
        "steeper seas break");
  const double peak = 1 / g.peak_period, bin = 2.5 * peak / g.components;
  double energy = 0;
  for (int i = 0; i < g.components; ++i) {
    const auto id = static_cast<std::uint64_t>(i);
    const double f = 0.5 * peak + (i + geom::uniform(g.seed, id, 0)) * bin;
    const double s = spectrum(f, peak, g.peak_enhancement) * bin;
    energy += s;
    components_.push_back({std::sqrt(2 * s), circle * f, linear_wave_number(1 / f, g.depth, g.gravity),
                           circle * geom::uniform(g.seed, id, 1)});
  }
  const double scale = 0.25 * g.significant_height / std::sqrt(energy);
  for (Component& c : components_)
    c.amplitude *= scale;
}

WaterPoint IrregularSea::at(const geom::Vec3& place, double time) const {
  const double s = (place - given_.origin).dot(along_), d = given_.depth;
  double eta = 0, slope = 0;
  std::vector<std::array<double, 2>> turns; // a cos, a sin
  turns.reserve(components_.size());
  for (const Component& c : components_) {
    const double angle = turned(c.wave_number * s - turned(c.omega * time) + c.phase);
    turns.push_back({c.amplitude * exact::cos(angle), c.amplitude * exact::sin(angle)});
    eta += turns.back()[0];
    slope -= c.wave_number * turns.back()[1];
  }
  WaterPoint point;
  point.surface = given_.level + eta;
  const double z = std::max(-d, std::min(place.z() - given_.level, eta));
  const double stretched = d + eta > 0 ? d * (z - eta) / (d + eta) : 0;
  double u = 0, w = 0, ax = 0, az = 0, head = eta - z;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Component& c = components_[i];
    const auto [cosine, sine] = turns[i];
    const double k = c.wave_number, rise = exact::exp(k * stretched),
                 under = exact::exp(-2 * k * (stretched + d)), bed = exact::exp(-2 * k * d);
    const double cosh = rise * (1 + under) / (1 - bed), sinh = rise * (1 - under) / (1 - bed); // over sinh kd
    u += c.omega * cosh * cosine;
    w += c.omega * sinh * sine;
    ax += c.omega * c.omega * cosh * sine;
    az -= c.omega * c.omega * sinh * cosine;
    head += (rise * (1 + under) / (1 + bed) - 1) * cosine;
  }
  point.velocity = u * along_ + w * geom::Vec3::UnitZ();
  point.acceleration = ax * along_ + az * geom::Vec3::UnitZ();
  point.surface_slope = slope * along_;
  point.pressure_gradient =
      given_.density * (-given_.gravity * geom::Vec3::UnitZ() - point.acceleration); // Euler's equation
  if (place.z() <= point.surface)
    point.pressure = given_.density * given_.gravity * std::max(0.0, head);
  return point;
}

} // namespace cdem
