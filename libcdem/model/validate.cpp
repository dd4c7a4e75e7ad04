#include "libcdem/model/material.hpp"

#include "libcdem/model/joint.hpp"
#include "libgeom/core/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

void require(bool ok, const char* field, double value, const char* allowed, const char* advice = "") {
  if (!ok)
    throw geom::InputError(field, fmt::format("{:g}", value), allowed, advice);
}

bool positive(double x) { return std::isfinite(x) && x > 0; }
bool not_negative(double x) { return std::isfinite(x) && x >= 0; }

} // namespace

void validate(const Elastic& m) {
  require(positive(m.youngs_modulus), "youngs_modulus", m.youngs_modulus, "a finite number > 0 Pa");
  require(m.poissons_ratio > -1 && m.poissons_ratio < 0.5, "poissons_ratio", m.poissons_ratio, "in (-1, 0.5)",
          "an incompressible material (0.5) locks; use at most 0.49");
  require(positive(m.density), "density", m.density, "a finite number > 0 kg/m3");
  require(not_negative(m.viscosity), "viscosity", m.viscosity, "a finite number >= 0 N s/m4");
}

void validate(const Joint& j) {
  require(not_negative(j.cohesion), "cohesion", j.cohesion, "a finite number >= 0 Pa");
  const double angle = j.friction_angle / degree;
  require(angle >= 0 && angle < 90, "friction_angle", angle, "in [0, 90) degrees");
  require(not_negative(j.tensile_strength), "tensile_strength", j.tensile_strength, "a finite number >= 0 Pa");
  require(positive(j.thickness_ratio) && j.thickness_ratio <= 1, "thickness_ratio", j.thickness_ratio, "in (0, 1]",
          "it is the joint's equivalent thickness over the block size");
  if (j.thickness)
    require(positive(*j.thickness), "thickness", *j.thickness, "a finite number > 0 m");
  if (j.normal_stiffness)
    require(positive(*j.normal_stiffness), "normal_stiffness", *j.normal_stiffness, "a finite number > 0 Pa/m");
  if (j.shear_stiffness)
    require(positive(*j.shear_stiffness), "shear_stiffness", *j.shear_stiffness, "a finite number > 0 Pa/m");
}

} // namespace cdem
