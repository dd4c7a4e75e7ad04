#include "libcdem/material/plasticity.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/core/types.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace cdem {
namespace {

// Rounding error of f = 0, over the largest stress or strength.
constexpr double rounding = 1e-10;

using Three = std::array<double, 3>;

struct Plane {
  Three a{}, b{}; // gradients of f and of the flow
  Three back{};   // C b
  double limit = 0;
};

double dot(const Three& x, const Three& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

// Hooke's law of principal strains.
Three hooke(const Three& e, double lambda, double shear) {
  const double pressure = lambda * (e[0] + e[1] + e[2]);
  return {pressure + 2 * shear * e[0], pressure + 2 * shear * e[1], pressure + 2 * shear * e[2]};
}

Plane shear_plane(int i, int j, const RockLimit& rock) {
  Plane plane;
  plane.a[i] = 1 + rock.sin_friction;
  plane.a[j] = -(1 - rock.sin_friction);
  plane.b[i] = 1 + rock.sin_dilation;
  plane.b[j] = -(1 - rock.sin_dilation);
  plane.limit = 2 * rock.cohesion * rock.cos_friction;
  return plane;
}

Plane tension_plane(int i, double limit) {
  Plane plane;
  plane.a[i] = plane.b[i] = 1;
  plane.limit = limit;
  return plane;
}

// Solves the n x n system m x = f by elimination with pivots; false where it is singular.
bool solve(int n, double (&m)[3][3], double (&f)[3]) {
  double largest = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      largest = std::max(largest, std::abs(m[i][j]));
  for (int i = 0; i < n; ++i) {
    int pivot = i;
    for (int k = i + 1; k < n; ++k)
      if (std::abs(m[k][i]) > std::abs(m[pivot][i]))
        pivot = k;
    if (!(std::abs(m[pivot][i]) > 1e-12 * largest))
      return false;
    std::swap(m[i], m[pivot]);
    std::swap(f[i], f[pivot]);
    for (int k = i + 1; k < n; ++k) {
      const double part = m[k][i] / m[i][i];
      for (int j = i; j < n; ++j)
        m[k][j] -= part * m[i][j];
      f[k] -= part * f[i];
    }
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j)
      f[i] -= m[i][j] * f[j];
    f[i] /= m[i][i];
  }
  return true;
}

// The planes in the order they are tried; six of them.
using Planes = std::array<Plane, 6>;

class Returning {
public:
  Returning(const Three& trial, double lambda, double shear, const RockLimit& rock)
      : trial_(trial), lambda_(lambda), shear_(shear) {
    const double tip = rock.sin_friction > 0 ? rock.cohesion * rock.cos_friction / rock.sin_friction
                                             : std::numeric_limits<double>::infinity();
    tensile_ = std::min(rock.tensile_strength, tip);
    planes_ = {shear_plane(0, 2, rock), tension_plane(0, tensile_), shear_plane(0, 1, rock),
               shear_plane(1, 2, rock), tension_plane(1, tensile_), tension_plane(2, tensile_)};
    for (Plane& plane : planes_)
      plane.back = hooke(plane.b, lambda, shear);
    tolerance_ = rounding * (std::abs(trial[0]) + std::abs(trial[2]) + rock.cohesion + tensile_);
  }

  bool holds(const Three& s) const {
    return std::all_of(planes_.begin(), planes_.end(),
                       [&](const Plane& p) { return dot(p.a, s) - p.limit <= tolerance_; });
  }

  // The return to so many planes; false where they are not the active ones.
  bool to(const int* active, int n, PlasticReturn& result) const {
    double m[3][3] = {}, load[3] = {};
    for (int i = 0; i < n; ++i) {
      const Plane& p = planes_[active[i]];
      for (int j = 0; j < n; ++j)
        m[i][j] = dot(p.a, planes_[active[j]].back);
      load[i] = dot(p.a, trial_) - p.limit;
    }
    if (!solve(n, m, load))
      return false;
    Three strain{}, s = trial_;
    for (int i = 0; i < n; ++i) {
      if (load[i] * shear_ < -tolerance_)
        return false;
      for (int k = 0; k < 3; ++k) {
        strain[k] += load[i] * planes_[active[i]].b[k];
        s[k] -= load[i] * planes_[active[i]].back[k];
      }
    }
    if (!holds(s))
      return false;
    result = {s, strain, n};
    return true;
  }

  // The tip, where all fails: no set of planes was the active one.
  PlasticReturn to_tip() const {
    PlasticReturn result;
    result.stress = {tensile_, tensile_, tensile_};
    const double bulk3 = 3 * lambda_ + 2 * shear_, mean = (trial_[0] + trial_[1] + trial_[2]) / 3;
    for (int k = 0; k < 3; ++k)
      result.strain[k] = (trial_[k] - mean) / (2 * shear_) + (mean - tensile_) / bulk3;
    result.planes = 3;
    return result;
  }

private:
  Three trial_;
  double lambda_, shear_, tensile_ = 0, tolerance_ = 0;
  Planes planes_;
};

double fallen(double peak, double residual, double part) {
  return peak + part * (residual - peak);
}

} // namespace

RockLimit limit_at(const Plasticity& rock, double plastic_strain) {
  const double part = rock.softening_strain > 0 ? std::min(1.0, plastic_strain / rock.softening_strain) : 0;
  const double tangent = fallen(geom::portable::tan(rock.friction_angle),
                                geom::portable::tan(rock.residual_friction_angle), part);
  RockLimit limit;
  limit.cohesion = fallen(rock.cohesion, rock.residual_cohesion, part);
  limit.tensile_strength = fallen(rock.tensile_strength, rock.residual_tensile_strength, part);
  limit.cos_friction = 1 / std::sqrt(1 + tangent * tangent);
  limit.sin_friction = tangent * limit.cos_friction;
  limit.sin_dilation = geom::portable::sin(rock.dilation_angle);
  if (rock.curve.on()) {
    limit.curve = rock.curve;
    limit.residual_curve = rock.residual_curve;
    limit.fallen = part;
  } else {
    limit.sin_dilation = std::min(limit.sin_dilation, limit.sin_friction);
  }
  return limit;
}

namespace {

// The tangent of a Hoek-Brown limit at p3.
RockLimit tangent_limit(const RockLimit& rock, double p3) {
  const double at = std::max(p3, -rock.tensile_strength);
  const auto mix = [&](double peak, double residual) { return fallen(peak, residual, rock.fallen); };
  const double n = mix(slope(rock.curve, at), slope(rock.residual_curve, at));
  const StraightStrength line =
      straight_strength(mix(strength(rock.curve, at), strength(rock.residual_curve, at)) - n * at, n);
  RockLimit limit;
  limit.cohesion = line.cohesion;
  limit.sin_friction = line.sin_friction;
  limit.cos_friction = line.cos_friction;
  limit.sin_dilation = std::min(rock.sin_dilation, line.sin_friction);
  limit.tensile_strength = rock.tensile_strength;
  return limit;
}

PlasticReturn return_to_straight_limit(const Three& trial, double lambda, double shear,
                                       const RockLimit& rock) {
  const Returning returning(trial, lambda, shear, rock);
  PlasticReturn result;
  result.stress = trial;
  if (returning.holds(trial))
    return result;
  // The usual sets first. A single plane can only be that of s1 and s3, or that of s1: the others are violated less.
  for (const int one : {0, 1})
    if (returning.to(&one, 1, result))
      return result;
  for (const auto& two : {std::array{0, 1}, std::array{0, 2}, std::array{0, 3}, std::array{1, 4}})
    if (returning.to(two.data(), 2, result))
      return result;
  constexpr int n = 6;
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j)
      if (const int two[] = {i, j}; returning.to(two, 2, result))
        return result;
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j)
      for (int k = j + 1; k < n; ++k)
        if (const int three[] = {i, j, k}; returning.to(three, 3, result))
          return result;
  return returning.to_tip();
}

} // namespace

PlasticReturn return_to_limit(const Three& trial, double lambda, double shear, const RockLimit& rock) {
  if (!rock.curve.on())
    return return_to_straight_limit(trial, lambda, shear, rock);
  constexpr int most = 50; // Newton's method needs 3 to 6
  PlasticReturn result;
  double p3 = -trial[0];
  for (int i = 0; i < most; ++i) {
    result = return_to_straight_limit(trial, lambda, shear, tangent_limit(rock, p3));
    const double before = std::exchange(p3, -result.stress[0]);
    if (std::abs(p3 - before) <= rounding * rock.curve.sigma_ci)
      break;
  }
  return result;
}

double plastic_step(const RockLimit& rock, double lambda, double shear, const double (&before)[6],
                    double (&stress)[6], double& plastic_strain) {
  geom::Mat3 trial;
  trial << stress[0], stress[3], stress[5], stress[3], stress[1], stress[4], stress[5], stress[4], stress[2];
  const Eigen::SelfAdjointEigenSolver<geom::Mat3> solver(trial);
  const geom::Vec3& s = solver.eigenvalues(); // ascending
  const PlasticReturn r = return_to_limit({s[2], s[1], s[0]}, lambda, shear, rock);
  if (r.planes == 0)
    return 0;
  const geom::Mat3& axes = solver.eigenvectors();
  const auto tensor = [&](const Three& principal) {
    return geom::Mat3(axes * geom::Vec3(principal[2], principal[1], principal[0]).asDiagonal() *
                      axes.transpose());
  };
  const geom::Mat3 after = tensor(r.stress), strain = tensor(r.strain);
  geom::Mat3 from;
  from << before[0], before[3], before[5], before[3], before[1], before[4], before[5], before[4], before[2];
  const double kept[6] = {after(0, 0), after(1, 1), after(2, 2), after(0, 1), after(1, 2), after(0, 2)};
  std::copy(std::begin(kept), std::end(kept), std::begin(stress));
  plastic_strain += std::sqrt(2 * dot(r.strain, r.strain) / 3);
  return 0.5 * (from + after).cwiseProduct(strain).sum();
}

std::vector<PlasticBound> bounds(const Plasticity& rock) {
  std::vector<PlasticBound> all;
  const auto add = [&](const StraightStrength& line, double tensile_strength) {
    const double reach = 2 + line.sin_friction / std::sqrt(3.0), c = line.cohesion * line.cos_friction;
    all.push_back(
        {2 * c, 2 * line.sin_friction, reach * reach,
         line.sin_friction > 0 ? std::min(tensile_strength, c / line.sin_friction) : tensile_strength});
  };
  for (const double strain : {0.0, rock.softening_strain}) {
    const RockLimit limit = limit_at(rock, strain);
    if (limit.curve.on())
      for (const StraightStrength& chord : chords(strain > 0 ? limit.residual_curve : limit.curve))
        add(chord, limit.tensile_strength);
    else
      add({limit.cohesion, limit.sin_friction, limit.cos_friction}, limit.tensile_strength);
  }
  return all;
}

bool has_strength(const Plasticity& rock) {
  return rock.cohesion > 0 || rock.friction_angle > 0 || rock.tensile_strength > 0 || rock.curve.on();
}

Plasticity reduced(Plasticity rock, double factor) {
  require_straight(rock.curve);
  const auto angle = [&](double phi) { return geom::portable::atan2(geom::portable::tan(phi), factor); };
  rock.cohesion /= factor;
  rock.residual_cohesion /= factor;
  rock.tensile_strength /= factor;
  rock.residual_tensile_strength /= factor;
  rock.friction_angle = angle(rock.friction_angle);
  rock.residual_friction_angle = angle(rock.residual_friction_angle);
  rock.dilation_angle = std::min(rock.dilation_angle, rock.friction_angle);
  return rock;
}

namespace {

void validate_curves(const Plasticity& rock) {
  const auto require_tension = [](const char* field, const HoekBrown& curve, double tension) {
    const double most = uniaxial_tensile_strength(curve);
    if (!(tension >= 0 && tension <= most * (1 + 1e-9)))
      throw geom::InputError(field, fmt::format("{:g}", tension),
                             fmt::format("from 0 to {:g} Pa, that of the curve", most));
  };
  require_tension("tensile_strength", rock.curve, rock.tensile_strength);
  require_tension("residual.tensile_strength", rock.residual_curve, rock.residual_tensile_strength);
  for (const double part : {0.0, 0.01, 0.1, 1.0})
    if (const double p3 = part * rock.curve.sigma_ci;
        !(strength(rock.residual_curve, p3) <= strength(rock.curve, p3) * (1 + 1e-12)))
      throw geom::InputError(
          "residual",
          fmt::format("{:g} Pa at the pressure p3 = {:g} Pa", strength(rock.residual_curve, p3), p3),
          fmt::format("at most the peak strength, {:g} Pa", strength(rock.curve, p3)),
          "strength falls, it does not grow");
}

} // namespace

void validate(const Plasticity& rock) {
  const auto degrees = [](double radians) { return fmt::format("{:g}", radians * 180 / M_PI); };
  const auto require = [](const char* field, const std::string& value, bool good, const std::string& range,
                          const std::string& advice = "") {
    if (!good)
      throw geom::InputError(field, value, range, advice);
  };
  const auto require_pressure = [&](const char* field, double value) {
    require(field, fmt::format("{:g}", value), value >= 0 && std::isfinite(value), "a finite number >= 0 Pa");
  };
  if (rock.curve.on())
    validate_curves(rock);
  require_pressure("cohesion", rock.cohesion);
  require_pressure("tensile_strength", rock.tensile_strength);
  const double most = M_PI / 2 * (1 - 1e-6);
  require("friction_angle", degrees(rock.friction_angle),
          rock.friction_angle >= 0 && rock.friction_angle < most, "in [0, 90) degrees");
  require("dilation_angle", degrees(rock.dilation_angle),
          rock.dilation_angle >= 0 &&
              (rock.dilation_angle <= rock.friction_angle || (rock.curve.on() && rock.dilation_angle < most)),
          rock.curve.on() ? "in [0, 90) degrees"
                          : "from 0 to friction_angle = " + degrees(rock.friction_angle) + " degrees");
  require("softening_strain", fmt::format("{:g}", rock.softening_strain),
          rock.softening_strain >= 0 && std::isfinite(rock.softening_strain), "a finite number > 0");
  const auto require_less = [&](const char* field, double residual, double peak, const std::string& shown,
                                const std::string& unit) {
    require(field, shown, residual >= 0 && residual <= peak, "from 0 to the peak value" + unit,
            "strength falls, it does not grow");
  };
  require_less("residual_cohesion", rock.residual_cohesion, rock.cohesion,
               fmt::format("{:g}", rock.residual_cohesion), "");
  require_less("residual_tensile_strength", rock.residual_tensile_strength, rock.tensile_strength,
               fmt::format("{:g}", rock.residual_tensile_strength), "");
  require_less("residual_friction_angle", rock.residual_friction_angle, rock.friction_angle,
               degrees(rock.residual_friction_angle), "");
}

} // namespace cdem
