// Rock engineering in scripts: laws of joint sets, glued cuts, stress with depth, displacement set to zero.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

namespace {

const std::string rock_head =
    "local cdem = require 'cdem'\n"
    "local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }\n"
    "local weak = cdem.coulomb{ friction_angle = 30 }\n"
    "local strong = cdem.mohr_coulomb{ cohesion = 1e6, friction_angle = 30, tensile_strength = 1e6 }\n"
    "local rocks = cdem.cut_by_joints{ shape = cdem.box{ size = {2, 2, 2} }, sets = {\n"
    "  { name = 'bedding', dip = 0, dip_direction = 0, spacing = 1 } } }\n"
    "rocks = cdem.cut_by_plane{ shape = rocks, point = {1, 1, 1}, normal = {1, 0, 0}, name = 'outline', "
    "glued = true }\n";

std::string model(const std::string& more = ", joints = { bedding = weak }") {
  return rock_head +
         "local m = cdem.model{ bodies = { { name = 'rock', shape = rocks, material = rock, joint = strong" +
         more + " } } }\n";
}

// Smooth walls and floor, weight.
const std::string walls =
    "m:fix{ on = { 'x-', 'x+' }, axes = 'x' }\nm:fix{ on = { 'y-', 'y+' }, axes = 'y' }\n"
    "m:fix{ on = 'z-', axes = 'z' }\nm:gravity{ vector = {0, 0, -10} }\n";

} // namespace

TEST_CASE("a body has a law for each joint set, and glued cuts", "[lua][rock]") {
  CHECK_THAT(error_of(model() + "local names = rocks:joint_sets()\nassert(#names == 2 and names[1] == "
                                "'bedding' and names[2] == 'outline')\n"
                                "local c = m:counts()\nassert(c.interfaces == 4)\n"
                                "assert(c.contacts == c.bonds / 2 and c.intact == c.bonds / 2)"),
             Equals(""));
  CHECK_THAT(error_of(rock_head +
                      "local g = cdem.glued{}\nassert(g.bonded and g.glued and g.thickness_ratio == 0.005)\n"
                      "assert(tostring(g) == 'cdem.Joint (glued, never breaks)')"),
             Equals(""));
}

TEST_CASE("names of joint sets that there are not are refused", "[lua][rock]") {
  CHECK_THAT(error_of(model(", joints = { beding = weak }")),
             Contains("\"beding\"") && Contains("\"bedding\""));
  CHECK_THAT(error_of(model(", joints = { bedding = rock }")), Contains("joints.bedding"));
  CHECK_THAT(error_of(model(", joints = { outline = weak }")), Contains("a cut that is not glued"));
}

TEST_CASE("stress with depth is in balance, and a K0 that joints cannot bear is told of", "[lua][rock]") {
  CHECK_THAT(error_of(model() + walls +
                      "assert(m:unbalance{}.largest > 0.1)\n"
                      "assert(m:initial_stress{ gradient = 25000, k0 = {0.5, 1} } == 0)\n"
                      "assert(m:unbalance{}.largest < 0.05)\n"
                      "assert(math.abs(m:at('stress.zz', {0.5, 1, 0.5}) + 1.5 * 25000) < 1)\n"
                      "assert(math.abs(m:at('stress.xx', {0.5, 1, 0.5}) + 0.75 * 25000) < 1)"),
             Equals(""));
  CHECK_THAT(
      Script(
          rock_head +
          "local dipping = cdem.cut_by_plane{ shape = cdem.box{ size = {1, 1, 1} }, point = {0.5, 0.5, 0.4}, "
          "normal = {1, 0, 1}, name = 'fault' }\n"
          "local m = cdem.model{ bodies = { { shape = dipping, material = rock, joint = strong, joints = { "
          "fault = "
          "weak } } } }\nm:initial_stress{ gradient = 25000, k0 = 0 }")
          .printed(),
      Contains("loaded beyond what the joint bears, at most 1.73 times its strength"));
}

TEST_CASE("initial_stress says what it lacks", "[lua][rock]") {
  CHECK_THAT(error_of(model() + "m:initial_stress{}"), Contains("give stress"));
  CHECK_THAT(error_of(model() + "m:initial_stress{ gradient = 25e3 }"), Contains("k0: missing"));
  CHECK_THAT(error_of(model() + "m:initial_stress{ gradient = 25e3, k0 = {1, 2, 3} }"), Contains("{kx, ky}"));
  CHECK_THAT(error_of(model() + "m:initial_stress{ gradient = 25e3, k0 = -1 }"),
             Contains("a finite number >= 0"));
  CHECK_THAT(error_of(model() + "m:initial_stress{ stress = {0, 0, 0, 0, 0, 0}, surface = 2 }"),
             Contains("surface: goes with gradient"));
  CHECK_THAT(Script(model() + "m:initial_stress{ gradient = 25, k0 = 1 }").printed(),
             Contains("initial_stress: gradient = 25: is it in Pa/m? Rock has 2e4"));
  CHECK_THAT(Script(model() + "m:initial_stress{ stress = {-2, -2, -5, 0, 0, 0} }").printed(),
             Contains("it is in Pa, 1 MPa is 1e6"));
  CHECK_THAT(Script(model() + "m:initial_stress{ stress = {2e6, 2e6, 5e6, 0, 0, 0} }").printed(),
             Contains("tension in the mean; the ground is under pressure, which is negative"));
}

TEST_CASE("gravity_stress leaves the stress of the weight and no displacement", "[lua][rock]") {
  CHECK_THAT(error_of(model() + "m:gravity_stress{}"), Contains("no gravity acts"));
  CHECK_THAT(error_of(model() + walls +
                      "local r = m:gravity_stress{}\nassert(r.converged and r.broken_tension == 0)\n"
                      "assert(m:max('displacement.magnitude') == 0)\n"
                      "assert(math.abs(m:reaction('z-')[3] / (2500 * 10 * 8) - 1) < 1e-4)\n"
                      "local before = m.state_hash\nm:reset_displacement()\nassert(m.state_hash == before)\n"
                      "assert(m:unbalance{}.largest < 1e-3)\n"
                      "m:remove{ on = cdem.select.box{ min = {-1, -1, 1}, max = {1, 3, 3} } }\n"
                      "m:relax{ breaking = false }\nassert(m:max('displacement.z') > 0)"),
             Equals(""));
}

TEST_CASE("the forces of an excavation stay, fall in a run and go when they are told to", "[lua][rock]") {
  const std::string dug = model("") + walls +
                          "m:gravity_stress{}\nm:reset_displacement()\n"
                          "local dug = cdem.select.box{ min = {-1, -1, 1}, max = {1, 3, 3} }\n";
  CHECK_THAT(error_of(dug +
                      "assert(m:remove{ on = dug, relaxed = 0 } == 1)\n"
                      "m:relax{ breaking = false, residual = 1e-6 }\n"
                      "assert(m:max('displacement.magnitude') < 1e-9)\n"
                      "m:relax_excavation{ relaxed = 0.5 }\nm:relax{ breaking = false, residual = 1e-6 }\n"
                      "local half = m:max('displacement.z')\nassert(half > 1e-7)\n"
                      "m:relax_excavation{ over = 0.02 }\nm:run{ duration = 0.05, local_damping = 0.3 }\n"
                      "assert(math.abs(m:max('displacement.z') / half - 2) < 0.02)"),
             Equals(""));
  CHECK_THAT(error_of(dug + "m:remove{ on = dug, relaxed = 1.5 }"), Contains("relaxed = 1.5"));
  CHECK_THAT(error_of(dug + "m:remove{ on = dug, relaxed = 0, over = 1 }"),
             Contains("over: goes with relaxed > 0"));
  CHECK_THAT(Script(dug + "m:relax_excavation{}").printed(), Contains("no forces of an excavation are kept"));
}

TEST_CASE("a water table is a plane, a profile, a file or a surface", "[lua][rock]") {
  CHECK_THAT(
      error_of(
          rock_head +
          "local t = cdem.water_table{ point = {0, 0, 5}, dip = 45, dip_direction = 90 }\n"
          "assert(math.abs(t:height(2, 7) - 3) < 1e-12)\n"
          "local p = cdem.water_table{ profile = { {0, 5}, {2, 3} } }\n"
          "assert(math.abs(p:height(1, 7) - 4) < 1e-12 and p:height(9, 0) == 3)\n"
          "local s = cdem.water_table{ surface = cdem.surface{ points = { {0, 0, 1}, {4, 0, 1}, {0, 4, 3} "
          "}, triangles = { {1, 2, 3} } } }\n"
          "assert(math.abs(s:height(1, 2) - 2) < 1e-12 and s:height(3, 3) == nil)\n"
          "cdem.write_csv{ file = 'table.csv', columns = { { name = 'distance', values = {0, 2} }, "
          "{ name = 'z', values = {5, 3} } } }\n"
          "assert(cdem.water_table{ file = 'table.csv', direction = {0, 1, 0} }:height(7, 1) == 4)"),
      Equals(""));
  CHECK_THAT(error_of(model("") +
                      "local t = cdem.water_table{ point = {0, 0, 1.8}, dip = 10, dip_direction = 90 }\n"
                      "local w = m:water{ joints = {'bedding'}, water_table = t }\n"
                      "local mean = 0.8 - math.tan(math.rad(10))\n"
                      "assert(math.abs(w.force / (9810 * 4 * mean) - 1) < 1e-9)\n"
                      "m:traction{ on = 'x-', water_table = t }"),
             Equals(""));
  CHECK_THAT(
      error_of(rock_head +
               "local p = cdem.water_table{ points = { {0, 0, 1}, {4, 0, 1}, {0, 4, 3}, {4, 4, 3} } }\n"
               "assert(math.abs(p:height(3, 2) - 2) < 1e-12 and p:height(5, 0) == nil)\n"
               "cdem.write_csv{ file = 'holes.csv', columns = { { name = 'X', values = {0, 4, 0} }, "
               "{ name = 'Y', values = {0, 0, 4} }, { name = 'Z', values = {1, 1, 3} } } }\n"
               "assert(math.abs(cdem.water_table{ file = 'holes.csv' }:height(1, 2) - 2) < 1e-12)"),
      Equals(""));
  CHECK_THAT(error_of(rock_head + "cdem.water_table{ points = { {0, 0, 1}, {4, 0, 1}, {8, 0, 3} } }"),
             Contains("on one line in plan"));
  CHECK_THAT(
      error_of(rock_head + "cdem.water_table{ points = { {0, 0, 1}, {4, 0, 1}, {4, 1, 3}, {4, 0, 2} } }"),
      Contains("points[4]") && Contains("point 2 is there already"));
  CHECK_THAT(error_of(rock_head + "cdem.water_table{ dip = 10 }"), Contains("point: missing"));
  CHECK_THAT(error_of(rock_head + "cdem.water_table{}"), Contains("give one of dip"));
  CHECK_THAT(error_of(rock_head + "cdem.water_table{ dip = 10, profile = { {0, 5}, {2, 3} } }"),
             Contains("give one of dip"));
  CHECK_THAT(error_of(rock_head + "cdem.water_table{ point = {0, 0, 1}, profile = { {0, 5}, {2, 3} } }"),
             Contains("point: goes with dip, not with profile"));
  CHECK_THAT(error_of(rock_head +
                      "cdem.write_csv{ file = 'table.csv', columns = { { name = 'x', values = {0, 2} } } }\n"
                      "cdem.water_table{ file = 'table.csv' }"),
             Contains("its columns must be distance and z"));
  CHECK_THAT(
      error_of(rock_head +
               "cdem.write_csv{ file = 'table.csv', columns = { { name = 'distance', values = {0, 0} }, "
               "{ name = 'z', values = {5, 3} } } }\ncdem.water_table{ file = 'table.csv' }"),
      Contains("table.csv") && Contains("distances rise"));
  CHECK_THAT(
      Script(rock_head + "cdem.water_table{ point = {0, 0, 1}, dip = 50, dip_direction = 90 }").printed(),
      Contains("dip = 50") && Contains("cos(dip)^2"));
}

TEST_CASE("a stereonet draws poles of lists, discs and cut blocks, and says what it drew in a table",
          "[lua][rock]") {
  CHECK_THAT(
      error_of(
          rock_head +
          "cdem.stereonet{ file = 'net.png', size = {400, 300}, shape = rocks,\n"
          "  poles = { { name = 'survey, north', planes = { {30, 90} } } },\n"
          "  discs = { { centre = {0, 0, 0}, dip = 90, dip_direction = 0, radius = 1, set = 'J1' } },\n"
          "  planes = { { name = 'face', dip = 60, dip_direction = 180 } } }\n"
          "local rows = {}\n"
          "for line in io.lines('net.csv') do\n"
          "  local kind, name, dip, to, x, y = line:match('^(%a+),(.+),([^,]+),([^,]+),([^,]+),([^,]+)$')\n"
          "  rows[#rows + 1] = { kind = kind, name = name, dip = tonumber(dip), to = tonumber(to),\n"
          "                      x = tonumber(x), y = tonumber(y) }\n"
          "end\n"
          "assert(#rows == 5 and rows[1].name == 'name')\n"
          "local survey, j1, bedding, face = table.unpack(rows, 2)\n"
          "assert(survey.name == '\"survey, north\"' and survey.dip == 30 and survey.to == 90)\n"
          "assert(math.abs(survey.x + math.sqrt(2) * math.sin(math.rad(15))) < 1e-8)\n"
          "assert(math.abs(survey.y) < 1e-8)\n"
          "assert(j1.name == 'J1' and math.abs(j1.y + 1) < 1e-8)\n"  // on the rim, to the south
          "assert(bedding.name == 'bedding' and bedding.dip == 0)\n" // once, though it makes four faces
          "assert(face.kind == 'plane' and face.dip == 60 and math.abs(face.y - math.sqrt(0.5)) < 1e-8)"),
      Equals(""));
  CHECK_THAT(error_of(rock_head + "cdem.stereonet{ file = 'net.png' }"),
             Contains("give poles, discs, shape or planes"));
  CHECK_THAT(error_of(rock_head + "cdem.stereonet{ file = 'net.png', shape = cdem.box{ size = {1, 1, 1} } }"),
             Contains("no joint set or cut"));
  CHECK_THAT(
      error_of(
          rock_head +
          "cdem.stereonet{ file = 'net.png', poles = { { name = 'a', planes = { {30, 90}, {95, 0} } } } }"),
      Contains("poles[1].planes[2]") && Contains("a dip from 0 to 90 degrees"));
  CHECK_THAT(
      error_of(rock_head +
               "cdem.stereonet{ file = 'net.bmp', planes = { { name = 'a', dip = 3, dip_direction = 0 } } }"),
      Contains(".png"));
}
