// Numbers beyond anything a model is made of: refused at once, with the range, before any work begins.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>
#include <chrono>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

// What cdem says to a script of one call, within a second.
std::string said_at_once(const std::string& call) {
  const auto began = std::chrono::steady_clock::now();
  const std::string error = error_of("local cdem = require 'cdem'\n" + call);
  CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count() < 1);
  return error;
}

} // namespace

TEST_CASE("lengths, directions and quantities have a range, and say it", "[lua]") {
  const std::string lengths = "from 1e-09 to 1e+08 m", places = "from -1e+08 to 1e+08 m",
                    quantities = "from -1e+60 to 1e+60";
  const std::string column_steps = column();
  for (const auto& [call, value, range] : std::vector<std::array<std::string, 3>>{
           {"cdem.voronoi{ size = {1e-160, 1, 1}, count = 100 }", "size[1] = 1e-160", lengths},
           {"cdem.voronoi{ size = {1, 1e300, 1}, count = 100 }", "size[2] = 1e+300", places},
           {"cdem.grid{ size = {1, 1, 1}, divisions = {1, 1, 1}, origin = {0, 2^53, 0} }", "origin[2]",
            places},
           {"cdem.bricks{ size = {1, 1, 1}, brick = {1, 1, 1e-200} }", "brick[3] = 1e-200", lengths},
           {"cdem.solid.cylinder{ base = {0, 0, 0}, axis = {0, 0, 1e160}, radius = 1 }", "axis[3] = 1e+160",
            places},
           {"cdem.solid.box{ size = {1, 1, 1} }:rotate{ axis = {0, 0, 1e160}, angle = 3 }", "axis[3]",
            quantities},
           {"cdem.cut_by_plane{ shape = cdem.box{ size = {1, 1, 1} }, point = {0, 0, 0}, normal = {1e160, 0, "
            "0} }",
            "normal[1] = 1e+160", quantities},
           {"cdem.convex_hull{ points = { {0, 0, 0}, {1, 0, 0}, {0, 1e160, 0}, {0, 0, 1} } }", "points[3][2]",
            places},
           {"cdem.elastic{ youngs_modulus = 1e200, poissons_ratio = 0.2, density = 2500 }", "youngs_modulus",
            quantities},
           {"cdem.drop{ unit = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }, count = 2, gap = "
            "2^53,\n"
            "  onto = cdem.box_mesh{ size = {9, 9, 1}, divisions = {1, 1, 1} } }",
            "gap", places}}) {
    INFO(call);
    const std::string error = said_at_once(call);
    CHECK_THAT(error, Contains(value) && Contains(range));
  }
}

TEST_CASE("counts that no machine holds are refused before they are made", "[lua]") {
  const std::string box = "cdem.solid.box{ size = {1, 1, 1} }";
  for (const auto& [call, message] : std::vector<std::array<std::string, 2>>{
           {"cdem.voronoi{ size = {1, 1, 1}, count = 2^32 + 1 }",
            "count = 4294967297: must be at most 2147483647"},
           {"cdem.grid{ size = {1, 1, 1}, divisions = {2^32 + 1, 1, 1} }", "divisions[1] = 4294967297"},
           {"cdem.grid{ size = {1, 1, 1}, divisions = {1e4, 1e4, 1e4} }", "at most 10 million blocks"},
           {"cdem.bricks{ size = {1e8, 1e8, 1e8}, brick = {1e-9, 1e-9, 1e-9} }", "at most 10 million blocks"},
           {"cdem.cut_by_joints{ shape = cdem.box{ size = {1, 1, 1} }, sets = { { dip = 30, dip_direction = "
            "0,\n"
            "  spacing = 1e-8 } } }",
            "at most 10 million blocks"},
           {"cdem.linspace(0, 1, 2^40)", "<= 10000000"},
           {"cdem.linspace(0, 1, 2^60)", "from -9e+15 to 9e+15"},
           {box + ":mesh{ size = 1e-4 }", "at most 20 million tetrahedra"},
           {box + ":mesh{ size = 1e-9 }", "at most 20 million tetrahedra"},
           // 2e12 tetrahedra in a corner that is a billionth of the box.
           {box + ":mesh{ size = 0.1, refine = { { at = {1e-3, 1e-3, 1e-3}, size = 1e-7, radius = 1e-3 } "
                  "} }",
            "at most 20 million tetrahedra"},
           {box + ":mesh{ size = 0.1, refine = { { line = { {0, 0, 0}, {1, 1, 1} }, size = 1e-5 } } }",
            "at most 20 million tetrahedra"},
           {"local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }\n"
            "local joint = cdem.mohr_coulomb{ cohesion = 1e6, friction_angle = 30, tensile_strength = 1e6 }\n"
            "cdem.model{ bodies = { { shape = cdem.grid{ size = {10, 10, 10}, divisions = {10, 10, 10} },\n"
            "  material = rock, joint = joint, name = 'a', zone_size = 0.03 } } }",
            "at most 20 million tetrahedra"}}) {
    INFO(call);
    CHECK_THAT(said_at_once(call), Contains(message));
  }
}

TEST_CASE("a box of Voronoi cells may be flat and long, but not out of all proportion", "[lua]") {
  const auto voronoi = [](const std::string& size) {
    return said_at_once("cdem.voronoi{ size = " + size + ", count = 50 }");
  };
  CHECK(voronoi("{1, 1, 1e-3}") == "");
  CHECK(voronoi("{1e3, 1, 1}") == "");
  CHECK_THAT(voronoi("{1, 1, 1e-9}"), Contains("size") && Contains("10000 times"));
  CHECK_THAT(voronoi("{1e8, 1, 1}"), Contains("size") && Contains("10000 times"));
  CHECK(error_of("require('cdem').voronoi{ size = {1, 1, 1e-6}, count = 50, extruded = true }") == "");
}
