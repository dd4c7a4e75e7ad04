// Hoek-Brown strength and pressure in cracks from scripts.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

namespace {

const std::string rock_mass_head =
    "local cdem = require 'cdem'\n"
    "local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }\n"
    "local cube = cdem.box_mesh{ size = {1, 1, 1}, divisions = {2, 2, 2} }\n"
    "local brittle = cdem.mohr_coulomb{ cohesion = 4e6, friction_angle = 30, tensile_strength = 1e6 }\n";

} // namespace

TEST_CASE("Hoek-Brown in scripts: as plasticity and as the joint of a cohesive body", "[lua][hoek_brown]") {
  CHECK_THAT(
      error_of(
          rock_mass_head +
          "local yields = cdem.hoek_brown{ sigma_ci = 30e6, gsi = 50, m_i = 10, residual = { gsi = 30 }, "
          "softening_strain = 0.01, dilation_angle = 10 }\n"
          "assert(math.abs(yields.tensile_strength / 69e3 - 1) < 0.02, yields.tensile_strength)\n"
          "local cracks = cdem.hoek_brown_bond{ sigma_ci = 30e6, gsi = 50, m_i = 10, friction_angle = 30 }\n"
          "assert(tostring(cracks):find('Hoek-Brown: sigma_ci 3e+07 Pa, m_b 1.67', 1, true), "
          "tostring(cracks))\n"
          "cdem.model{ bodies = { { shape = cube, material = rock, plasticity = yields } } }\n"
          "cdem.model{ bodies = { { shape = cube, material = rock, joint = cracks } } }\n"),
      Equals(""));
}

TEST_CASE("Hoek-Brown in scripts: what cannot be is refused with one line", "[lua][hoek_brown][input]") {
  const auto refused = [](const std::string& law) { return error_of(rock_mass_head + "local law = " + law); };
  const std::string mass = "sigma_ci = 30e6, gsi = 50, m_i = 10";
  CHECK_THAT(refused("cdem.hoek_brown{ sigma_ci = 30e6, gsi = 101, m_i = 10 }"), Contains("gsi = 101"));
  CHECK_THAT(refused("cdem.hoek_brown{ " + mass + ", residual = { gsi = 30 } }"),
             Contains("softening_strain: goes together with residual"));
  CHECK_THAT(refused("cdem.hoek_brown{ " + mass + ", residual = { gsi = 60 }, softening_strain = 0.01 }"),
             Contains("strength falls, it does not grow"));
  CHECK_THAT(refused("cdem.hoek_brown{ " + mass + ", tensile_strength = 1e6 }"),
             Contains("tensile_strength = 1e+06"));
  CHECK_THAT(refused("cdem.hoek_brown_bond{ " + mass + " }"), Contains("friction_angle"));
  CHECK_THAT(
      error_of(
          rock_mass_head + "local law = cdem.hoek_brown_bond{ " + mass +
          ", friction_angle = 30 }\n"
          "cdem.model{ bodies = { { shape = cube, material = rock, joint = law, bonds = 'springs' } } }"),
      Contains("bonds = \"cohesive\""));
}

TEST_CASE("pressure in cracks is given, or that of a pumped fluid", "[lua][crack_pressure][input]") {
  const auto pressed = [](const std::string& by, const std::string& joint = ", joint = brittle") {
    return error_of(rock_mass_head + "local m = cdem.model{ bodies = { { shape = cube, material = rock" +
                    joint + " } } }\nm:fix{ on = 'z-' }\nm:crack_pressure{ " + by +
                    " }\nm:run{ steps = 5 }\n");
  };
  CHECK_THAT(pressed("pressure = 1e5, amplitude = { {0, 0}, {1, 1} }"), Equals(""));
  CHECK_THAT(pressed("volume = 1e-6, bulk_modulus = 2.2e9, reservoir = 1e-3"), Equals(""));
  CHECK_THAT(pressed(""), Contains("give one of pressure = Pa and volume = m3"));
  CHECK_THAT(pressed("volume = 1e-6, bulk_modulus = 2.2e9"), Contains("reservoir: goes with volume"));
  CHECK_THAT(pressed("pressure = 1e5, bulk_modulus = 2.2e9"), Contains("bulk_modulus: goes with volume"));
  CHECK_THAT(pressed("pressure = 1e5", ""), Contains("inner faces of a cohesive body"));
  CHECK_THAT(pressed("pressure = 1e5, amplitude = function(t) return t - 1 end"),
             Contains("a finite pressure >= 0"));
}
