#include "libcdem/material/elastic.hpp"

#include "libcdem/joint/joint.hpp"
#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/portable.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

using geom::require;
using geom::require_above;
using geom::require_at_least;
using geom::require_in;

constexpr double degree = 3.14159265358979323846 / 180;

void validate_softening(const Joint& j) {
  const char* const advice =
      "a softening bond needs both fracture energies; with softening = none it is brittle";
  if (j.softening == Softening::none) {
    const char* const none = "left out without softening";
    const char* const choose =
        "a brittle bond has no fracture energy; choose softening = linear or exponential";
    require(j.fracture_energy_1 == 0, "fracture_energy_1", j.fracture_energy_1, none, choose);
    require(j.fracture_energy_2 == 0, "fracture_energy_2", j.fracture_energy_2, none, choose);
    return;
  }
  if (!j.bonded)
    throw geom::InputError("softening", j.softening == Softening::linear ? "linear" : "exponential",
                           "none for a joint that is not bonded", "a contact has no strength to lose");
  require_above("fracture_energy_1", j.fracture_energy_1, 0, "J/m2", advice);
  require_above("fracture_energy_2", j.fracture_energy_2, 0, "J/m2", advice);
  require_above("cohesion", j.cohesion, 0, "Pa with softening",
                "without strength there is nothing to soften");
  require_above("tensile_strength", j.tensile_strength, 0, "Pa with softening",
                "without strength there is nothing to soften");
  // Beyond the cone's tip pure tension would break the bond in shear, and G_I would not be what opening it
  // takes.
  const double tip = j.cohesion / geom::portable::tan(j.friction_angle);
  require(j.tensile_strength <= tip * (1 + 1e-12), "tensile_strength", j.tensile_strength,
          fmt::format("at most cohesion / tan(friction_angle) = {:g} Pa with softening", tip),
          "the tip of the Mohr-Coulomb cone");
}

void validate_scatter(const Joint& j) {
  const StrengthScatter& s = j.scatter;
  if (s.modulus == 0)
    return;
  require_in("weibull.modulus", s.modulus, "[2, 1000]", "concrete and rock have about 5 to 25");
  require_above("weibull.reference_volume", s.reference_volume, 0, "m3",
                "the volume whose mean strength the joint gives");
  if (!j.bonded)
    throw geom::InputError("weibull", "of a contact", "of a joint that is bonded",
                           "a contact has no strength to scatter");
}

void validate_rate_effect(const Joint& j) {
  const RateEffect& r = j.rate;
  if (r.reference_rate == 0)
    return;
  require_above("rate_effect.reference_rate", r.reference_rate, 0, "1/s",
                "the rate of strain at which the strengths were measured");
  require_in("rate_effect.exponent", r.exponent, "[0, 1]",
             "0.018 for concrete in tension (fib Model Code 2010)");
  require(r.change_rate > r.reference_rate, "rate_effect.change_rate", r.change_rate,
          "above reference_rate, 1/s", "the rate from which exponent_above holds");
  require_in("rate_effect.exponent_above", r.exponent_above, "[0, 1]",
             "1/3 for concrete in tension (fib Model Code 2010)");
  if (!j.bonded)
    throw geom::InputError("rate_effect", "of a contact", "of a joint that is bonded",
                           "a contact has no strength to raise");
}

void validate_law(const Joint& j) {
  if (!has_law(j.law))
    return;
  with_law(j.law, [](const auto& law) { law.validate(); });
  if (j.softening != Softening::none)
    throw geom::InputError("softening", "with residual strength or dilation", "none there",
                           "a joint that softens goes on with its friction alone");
  const auto* const residual = std::get_if<ResidualStrength>(&j.law);
  if (!residual)
    return;
  const double peak = geom::portable::tan(j.friction_angle);
  require(residual->friction <= peak * (1 + 1e-12), "residual_friction_angle",
          std::atan(residual->friction) / degree, "in [0, friction_angle] degrees",
          "the residual is not above the peak");
  require(residual->cohesion <= j.cohesion, "residual_cohesion", residual->cohesion,
          fmt::format("in [0, {:g}] Pa, at most the cohesion", j.cohesion),
          "the residual is not above the peak");
  require(residual->tension <= j.tensile_strength, "residual_tensile_strength", residual->tension,
          fmt::format("in [0, {:g}] Pa, at most the tensile strength", j.tensile_strength),
          "the residual is not above the peak");
}

void validate_curve(const Joint& j) {
  if (!j.curve.on())
    return;
  const double most = uniaxial_tensile_strength(j.curve);
  require(j.tensile_strength <= most * (1 + 1e-9), "tensile_strength", j.tensile_strength,
          fmt::format("at most {:g} Pa, that of the Hoek-Brown curve", most));
  if (j.softening != Softening::none || j.scatter.on() || j.rate.on())
    throw geom::InputError("softening, weibull and rate_effect", "with a Hoek-Brown strength", "left out",
                           "its faces are brittle");
}

// Three digits, rounded up so that the printed value is itself allowed.
std::string at_least(double x) {
  const double digit = std::pow(10.0, std::floor(std::log10(x)) - 2);
  return fmt::format("{:g}", std::ceil(x / digit) * digit);
}

void require_energy(const char* field, double energy, double strength, double stiffness, const char* letter) {
  const double stored = strength * strength / (2 * stiffness);
  if (energy < stored)
    throw geom::InputError(
        field, fmt::format("{:g}", energy),
        fmt::format(
            "at least {} J/m2, what a spring of stiffness {} = {:g} Pa/m stores at its strength of {:g} Pa",
            at_least(stored), letter, stiffness, strength),
        "raise it, or stiffen the joint (smaller thickness_ratio)");
}

} // namespace

void validate(const Elastic& m) {
  require_above("youngs_modulus", m.youngs_modulus, 0, "Pa");
  require_in("poissons_ratio", m.poissons_ratio, "(-1, 0.5)",
             "an incompressible material (0.5) locks; use at most 0.49");
  require_above("density", m.density, 0, "kg/m3");
  require_at_least("viscosity", m.viscosity, 0, "N s/m4");
  require_at_least("stiffness_damping", m.stiffness_damping, 0, "s");
}

Joint glued_joint() {
  Joint joint;
  joint.glued = true;
  joint.thickness_ratio = glued_thickness_ratio;
  return joint;
}

void validate(const Joint& j) {
  require_at_least("cohesion", j.cohesion, 0, "Pa");
  const double angle = j.friction_angle / degree;
  require(angle >= 0 && angle < 90, "friction_angle", angle, "in [0, 90) degrees");
  require_at_least("tensile_strength", j.tensile_strength, 0, "Pa");
  require_in("thickness_ratio", j.thickness_ratio, "(0, 1]",
             "it is the joint's equivalent thickness over the block size");
  if (j.thickness)
    require_above("thickness", *j.thickness, 0, "m");
  if (j.normal_stiffness)
    require_above("normal_stiffness", *j.normal_stiffness, 0, "Pa/m");
  if (j.shear_stiffness)
    require_above("shear_stiffness", *j.shear_stiffness, 0, "Pa/m");
  require_at_least("stiffness_damping", j.stiffness_damping, 0, "s");
  require_in("restitution", j.restitution, "(0, 1]",
             "it is the speed after an impact over the speed before it");
  validate_softening(j);
  validate_scatter(j);
  validate_rate_effect(j);
  validate_law(j);
  validate_curve(j);
}

double friction_left(const Joint& j) {
  const JointSpring spring{0, 0, geom::portable::tan(j.friction_angle)};
  return has_law(j.law) ? with_law(j.law, [&](const auto& law) { return law.friction_left(spring); })
                        : spring.tan_friction;
}

void validate(const Joint& j, double normal_stiffness, double shear_stiffness) {
  with_law(j.law, [&](const auto& law) { law.validate({normal_stiffness, shear_stiffness, 0}); });
  if (j.softening == Softening::none)
    return;
  validate_softening(j);
  require_energy("fracture_energy_1", j.fracture_energy_1, j.tensile_strength, normal_stiffness, "kn");
  require_energy("fracture_energy_2", j.fracture_energy_2, j.cohesion, shear_stiffness, "ks");
}

} // namespace cdem
