// What a script is warned of, and where the warnings go.
#include "tests/lua/script.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

std::vector<std::string> warnings_of(const std::string& text) {
  Script script(text);
  script.run();
  std::vector<std::string> warnings;
  for (const std::string& line : script.listener->lines)
    if (line.find("warning: ") != std::string::npos)
      warnings.push_back(line);
  return warnings;
}

const std::string pull = "model:traction{ on = 'x+', stress = {1e6, 0, 0} }\n";

} // namespace

TEST_CASE("a relaxation that does not converge warns and says so in its result", "[lua]") {
  const auto warnings = warnings_of(column() + pull + "assert(not model:relax{ max_steps = 5 }.converged)");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("case.lua:8: warning: relax: not converged after 5 steps"));
}

TEST_CASE("a relaxation on which nothing acts warns", "[lua]") {
  const auto warnings = warnings_of(column() + "model:relax{}");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("nothing acts on the model"));
  CHECK(warnings_of(column() + pull + "model:relax{}").empty());
}

TEST_CASE("a settling on which nothing acts warns", "[lua]") {
  const std::string gravity = "model:gravity{ vector = {0, 0, -9.81} }\n";
  const std::string settle = "model:settle{ max_time = 1e-3 }";
  const auto is_told = [](const std::string& text) {
    const auto warnings = warnings_of(text);
    return std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
      return warning.find("settle: nothing acts on the model") != std::string::npos;
    });
  };
  CHECK(is_told(column() + settle));
  CHECK_FALSE(is_told(column() + gravity + settle));
}

TEST_CASE("a settling that does not come to rest names what moves most", "[lua]") {
  const auto warnings = warnings_of(column() + "model:gravity{ vector = {0, 0, -9.81} }\n" +
                                    "assert(not model:settle{ max_time = 1e-3 }.converged)");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("settle: after 0.001 s the kinetic energy is ") &&
                              Contains(" moves most, at 0.0097") &&
                              Contains(" m/s; look whether it falls off"));
}

TEST_CASE("a mesh size beyond the solid is told of with four digits where the body deforms", "[lua]") {
  const auto of = [](const std::string& element) {
    return warnings_of(
        "local cdem = require 'cdem'\n"
        "local mesh = cdem.solid.box{ size = {1 / 3, 2, 3} }:mesh{ size = 2 / 3 }\n"
        "local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }\n"
        "cdem.model{ bodies = { { shape = mesh, material = rock, name = 'plate'" +
        element + " } } }");
  };
  const auto warnings = of("");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0],
             Contains("mesh: size = 0.6667 m is more than the solid's smallest extent, 0.3333 m;"));
  CHECK(of(", element = 'rigid'").empty());
}

TEST_CASE("a mesh that lacks volume of its solid is told of", "[lua]") {
  const auto of = [](const std::string& size) {
    return warnings_of("local cdem = require 'cdem'\n"
                       "cdem.solid.sphere{ radius = 1 }:mesh{ size = " +
                       size + " }");
  };
  REQUIRE(of("1").size() == 1);
  CHECK_THAT(of("1")[0], Contains("case.lua:2: warning: mesh: with size = 1 m its volume, and mass, is 0."));
  CHECK(of("0.2").empty());
}

TEST_CASE("a layer that misses the density asked for is told of", "[lua]") {
  const auto warnings =
      warnings_of("local cdem = require 'cdem'\n"
                  "local cube = cdem.cube{ height = 1 }:mesh{ size = 1 }\n"
                  "local ground = cdem.slope{ gradient = 2 / 3, length = 12, width = 12 }:mesh{ size = 3 }\n"
                  "cdem.place{ unit = cube, count = 12, columns = 4, onto = ground, density = 1.3, "
                  "attitudes = 20, nudges = 20 }");
  CHECK(std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
    return warning.find("cdem.place: density = 1.3 came to 0.") != std::string::npos;
  }));
}

TEST_CASE("a friction angle in radians is told of", "[lua]") {
  const auto of = [](const std::string& joint) {
    return warnings_of("local cdem = require 'cdem'\ncdem." + joint + " }");
  };
  REQUIRE(of("coulomb{ friction_angle = 0.52").size() == 1);
  CHECK_THAT(of("coulomb{ friction_angle = 0.52")[0],
             Contains("friction_angle = 0.52: no rock is as smooth; it is in degrees"));
  CHECK(of("mohr_coulomb{ friction_angle = 0.52, cohesion = 1e6, tensile_strength = 1e6").size() == 1);
  CHECK(of("coulomb{ friction_angle = 30").empty());
  CHECK(of("coulomb{ friction_angle = 0").empty());
}

TEST_CASE("a Young's modulus that no solid has warns, and none that one has", "[lua]") {
  const auto elastic = [](const std::string& modulus) {
    return warnings_of("local cdem = require 'cdem'\ncdem.elastic{ youngs_modulus = " + modulus +
                       ", poissons_ratio = 0.2, density = 2500 }");
  };
  for (const std::string modulus : {"30", "99e3", "30e15"}) {
    const auto warnings = elastic(modulus);
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0],
               Contains("case.lua:2: warning: cdem.elastic: youngs_modulus = ") && Contains("Pa"));
  }
  for (const std::string modulus : {"1e5", "1e6", "30e9", "1.2e12"})
    CHECK(elastic(modulus).empty());
}

// Nu is 0 and the load uniform: the strain is sigma / E, E = 1 GPa.
TEST_CASE("a stage that leaves small strain warns once", "[lua]") {
  const auto pulled = [](const std::string& stress) {
    return warnings_of(column() + "model:traction{ on = 'x+', stress = {" + stress +
                       ", 0, 0} }\nmodel:relax{ breaking = false }");
  };
  CHECK(pulled("9.5e6").empty());
  const auto warnings = pulled("12e6");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("stage 1 (relax): beyond small strain") && Contains("strained by 1.2 %"));
}

TEST_CASE("a block that has turned by more than a degree is told of", "[lua]") {
  // A box of 1 m thrown so that it spins at 1 rad/s about z: 0.02 s is 1.15 degrees.
  const std::string spin =
      "local cdem = require 'cdem'\n"
      "local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0, density = 2000 }\n"
      "local model = cdem.model{ bodies = { { shape = cdem.box{ size = {1, 1, 1} }, "
      "material = rock, element = 'small_strain' } } }\n"
      "for _, p in ipairs{ {0, 0}, {1, 0}, {0, 1}, {1, 1} } do\n"
      "  local on = cdem.select.where(function(x, y)\n"
      "    return math.abs(x - p[1]) < 0.01 and math.abs(y - p[2]) < 0.01 end)\n"
      "  model:fix{ on = on, axes = 'xy', velocity = {0.5 - p[2], p[1] - 0.5, 0} }\n"
      "end\n";
  CHECK(warnings_of(spin + "model:run{ duration = 0.01, safety = 0.2 }").empty());
  const auto warnings = warnings_of(spin + "model:run{ duration = 0.02, safety = 0.2 }");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("has turned by 1.1") && Contains("more than 1"));
}

TEST_CASE("the report holds the run's warnings, also those that come after its figures", "[lua]") {
  Script script(column() + "cdem.report{ { name = 'a', value = 1 } }\nmodel:relax{}");
  script.run();
  CHECK_THAT(script.read("report.json"),
             Contains("\"warnings\": [\n") && Contains("case.lua:8: warning: relax: nothing"));
  CHECK_THAT(script.read("report.md"),
             Contains("- ") && Contains("case.lua:8: warning: relax: nothing acts"));
  Script quiet("local cdem = require 'cdem'\ncdem.report{ { name = 'a', value = 1 } }");
  quiet.run();
  CHECK_THAT(quiet.read("report.json"), Contains("\"warnings\": []"));
}
