// Laws of joints, water and results of joints in scripts.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

namespace {

const std::string joint_laws_head =
    "local cdem = require 'cdem'\n"
    "local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0, density = 2500 }\n";

// Two flat blocks pressed together, on the joint "seam".
std::string box(const std::string& law) {
  return joint_laws_head + "local law = " + law +
         "\n"
         "local shape = cdem.cut_by_plane{ shape = cdem.box{ size = {1, 1, 0.25} }, point = {0, 0, 0.2}, "
         "normal = {0, 0, 1}, name = 'seam' }\n"
         "local m = cdem.model{ bodies = { { name = 'rock', shape = shape, material = rock, joint = "
         "cdem.mohr_coulomb{ cohesion = 1e6, friction_angle = 30, tensile_strength = 1e6 }, joints = { seam "
         "= law } } } }\n"
         "m:fix{ on = 'z-', axes = 'xyz' }\nm:fix{ on = 'z+', axes = 'y' }\n"
         "m:traction{ on = 'z+', stress = {0, 0, -1e6} }\n";
}

const std::string contact = "cdem.coulomb{ friction_angle = 30 }";

} // namespace

TEST_CASE("laws of joints are made, told in words and used by a joint set", "[lua][joint_laws]") {
  CHECK_THAT(
      error_of(box("cdem.coulomb{ friction_angle = 30, residual_friction_angle = 25, dilation_angle = 10, "
                   "dilation_limit = 2e-3 }") +
               "assert(tostring(law):find('residual c 0 Pa, tension 0 Pa, friction angle 25 deg, dilation 10 "
               "deg', 1, true), tostring(law))\n"
               "assert(m:relax{}.converged)\n"),
      Equals(""));
  CHECK_THAT(error_of(box("cdem.barton_bandis{ jrc = 10, jcs = 100e6, residual_friction_angle = 28, "
                          "initial_stiffness = 2e9, maximum_closure = 1e-3, length = 1 }") +
                      "assert(tostring(law):find('Barton-Bandis, JRC 6.3', 1, true), tostring(law))\n"
                      "assert(m:relax{}.converged)\n"
                      "local s = m:joints{ sets = {'seam'} }[1]\n"
                      "assert(math.abs(s.opening + 1e6 / (2e9 + 1e9)) < 1e-5, s.opening)"),
             Equals(""));
  CHECK_THAT(error_of(box("cdem.joint_table{ normal = { {0, 0}, {1e-3, 0.5e6}, {1.5e-3, 1.5e6} }, shear = { "
                          "{0, 1e5}, {2e6, 9e5} } }") +
                      "assert(m:relax{}.converged)\n"
                      "assert(math.abs(m:joints{}[1].opening + 1.25e-3) < 1e-5)"),
             Equals(""));
}

TEST_CASE("laws that cannot be are refused with one line", "[lua][joint_laws]") {
  const auto refused = [](const std::string& law) {
    return error_of(joint_laws_head + "local law = " + law);
  };
  CHECK_THAT(refused("cdem.coulomb{ friction_angle = 30, dilation_angle = 35 }"),
             Contains("dilation_angle = 35: must be in [0, residual friction angle] degrees"));
  CHECK_THAT(refused("cdem.coulomb{ friction_angle = 30, residual_friction_angle = 31 }"),
             Contains("residual_friction_angle = 31: must be in [0, friction_angle] degrees"));
  CHECK_THAT(refused("cdem.coulomb{ friction_angle = 30, dilation_limit = 1 }"),
             Contains("dilation_limit: goes with dilation_angle"));
  CHECK_THAT(refused("cdem.mohr_coulomb{ cohesion = 1e6, friction_angle = 30, tensile_strength = 1e5, "
                     "residual_tensile_strength = 2e5 }"),
             Contains("residual_tensile_strength = 200000"));
  CHECK_THAT(refused("cdem.barton_bandis{ jrc = 25, jcs = 1e8, residual_friction_angle = 28, "
                     "initial_stiffness = 2e9, maximum_closure = 1e-3 }"),
             Contains("jrc = 25"));
  CHECK_THAT(refused("cdem.joint_table{ normal = { {0, 0}, {1e-3, 1e6}, {0.5e-3, 2e6} }, shear = { {0, 0}, "
                     "{1e6, 1e6} } }"),
             Contains("normal[3] = 0.0005: must be above the 0.001 of the row before"));
}

TEST_CASE("water in joints: level, table, function, and what is refused", "[lua][water]") {
  const std::string m = box(contact);
  CHECK_THAT(error_of(m + "local w = m:water{ pressure = 0.4e6, joints = {'seam'} }\n"
                          "assert(math.abs(w.force - 0.4e6) < 1 and math.abs(w.area - 1) < 1e-9)\n"
                          "assert(m:relax{}.converged)\n"
                          "local s = m:joints{}[1]\n"
                          "assert(s.set == 'seam' and math.abs(s.normal_traction + 0.6e6) < 10)\n"
                          "assert(math.abs(s.water_pressure - 0.4e6) < 1e-3)\n"
                          "assert(m:water{ level = 0.25 }.largest < 500)\n"
                          "assert(math.abs(m:water{ table = { {0, 1e5}, {0.4, 0} } }.largest - 0.5e5) < 1)\n"
                          "local calls = 0\n"
                          "m:water{ pressure = function(x, y, z) calls = calls + 1 return 1e5 * x end }\n"
                          "local before = calls\nm:relax{}\nassert(before > 0 and calls == before)\n"
                          "assert(m:water{ pressure = 0 }.points == 0)"),
             Equals(""));
  CHECK_THAT(Script(m + "m:water{ level = 0.25, weight = 9.81 }").printed(),
             Contains("water: weight = 9.81: is it in N/m3? Water has 9810"));
  CHECK_THAT(error_of(m + "m:water{}"), Contains("give one of level"));
  CHECK_THAT(error_of(m + "m:water{ level = 3 }"), Contains("at most the top of the model, 0.25 m"));
  CHECK_THAT(error_of(m + "m:water{ level = 0.25, joints = {'seem'} }"), Contains("(\"seam\")"));
  CHECK_THAT(error_of(m + "m:water{ pressure = function() return -1 end }"),
             Contains("must be a finite number >= 0 Pa"));
  CHECK_THAT(error_of(m + "m:water{ table = { {0, 1}, {0, 2} } }"), Contains("pressure[2] = 0"));
  CHECK_THAT(error_of(m + "m:joints{ sets = {'fault'} }"), Contains("set = \"fault\""));
}

TEST_CASE("results of joints point by point and as files", "[lua][joints]") {
  CHECK_THAT(error_of(box(contact) +
                      "m:relax{}\nlocal p = m:joint_points{}\n"
                      "assert(#p.place > 3 and #p.place == #p.slip and p.set[1] == 'seam' and p.mode[1] == "
                      "'contact')\n"
                      "local area = 0\nfor _, a in ipairs(p.area) do area = area + a end\n"
                      "assert(math.abs(area - 1) < 1e-9)\n"
                      "assert(math.abs(p.normal_traction[1] + 1e6) < 1e3 and p.utilisation[1] < 0.01)\n"
                      "m:save_joints{ file = 'joints.vtp', sets = {'seam'} }\n"
                      "m:picture{ file = 'slip.png', colour = 'joint_slip', size = {200, 200} }\n"
                      "m:picture{ file = 'use.png', colour = 'joint_utilisation', size = {200, 200} }"),
             Equals(""));
}

TEST_CASE("discs of a fracture network are read from a table and cut the blocks they reach", "[lua][discs]") {
  Script script(
      joint_laws_head +
      "local discs = cdem.read_discs('dfn.csv')\n"
      "assert(#discs == 2 and discs[2].set == 'east' and math.abs(discs[2].dip - 60) < 1e-9)\n"
      "local shape = cdem.cut_by_discs{ shape = cdem.box{ size = {2, 2, 2} }, discs = discs }\n"
      "assert(#shape:blocks() == 3)\n"
      "local names = shape:joint_sets()\nassert(names[1] == 'east' and names[2] == 'level')\n"
      "local m = cdem.model{ bodies = { { name = 'rock', shape = shape, material = rock, joint = "
      "cdem.mohr_coulomb{ cohesion = 1e6, friction_angle = 30, tensile_strength = 1e6 }, joints = { level "
      "= cdem.coulomb{ friction_angle = 30 } } } } }\n"
      "assert(m:joints{ sets = {'level'} }[1].area > 3.9)");
  script.write("dfn.csv",
               "id,x,y,z,dip,dip_direction,radius,set\n1,1,1,1,0,0,5,level\n2,1,1,1.6,60,90,0.3,east\n");
  CHECK_THAT(script.error(), Equals(""));
  CHECK_THAT(error_of(joint_laws_head +
                      "cdem.cut_by_discs{ shape = cdem.box{ size = {2, 2, 2} }, discs = { { centre = {1, 1, "
                      "1}, dip = 95, dip_direction = 0, radius = 1, set = 'a' } } }"),
             Contains("dip = 95"));
}

TEST_CASE("water is part of a saved state", "[lua][water][checkpoint]") {
  const std::string text = box("cdem.barton_bandis{ jrc = 10, jcs = 100e6, residual_friction_angle = 28, "
                               "initial_stiffness = 2e9, maximum_closure = 1e-3, length = 1 }") +
                           "m:relax{}\nm:water{ pressure = function(x) return 1e5 * x end }\n"
                           "m:save_state{ file = 'wet.cdem' }\n"
                           "m:water{ pressure = 0 }\nm:run{ steps = 50 }\n"
                           "m:load_state{ file = 'wet.cdem' }\n"
                           "assert(m:joints{}[1].water_pressure > 4e4)";
  CHECK_THAT(error_of(text), Equals(""));
}

TEST_CASE("a restitution can be asked for of every contact that never was bonded", "[lua][joint_laws]") {
  Script script(R"(
local cdem = require "cdem"
local function rough(e)
  return cdem.barton_bandis{ jrc = 5, jcs = 50e6, residual_friction_angle = 30, initial_stiffness = 1e10,
                             maximum_closure = 1e-4, length = 1, restitution = e }
end
assert(rough().restitution == 1 and rough(0.5).restitution == 0.5)
assert(cdem.joint_table{ shear = {{0, 0}, {1e6, 5e5}}, restitution = 0.5 }.restitution == 0.5)
)");
  script.run();
}
