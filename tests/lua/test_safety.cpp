// The verdict of a relaxation and the factor of safety in scripts.
#include "tests/lua/script.hpp"

#include "lua/binding/module/module.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

namespace {

// A block on an incline of 25 degrees that leans with gravity: F = tan(phi) / tan(25).
const std::string safety_head =
    "local cdem = require 'cdem'\n"
    "local stone = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }\n"
    "local function incline(phi)\n"
    "  local m = cdem.model{ bodies = {\n"
    "    { name = 'base', shape = cdem.box{ size = {3, 1, 0.5}, origin = {-1, 0, -0.5} }, material = stone "
    "},\n"
    "    { name = 'block', shape = cdem.box{ size = {1, 1, 0.5} }, material = stone } },\n"
    "    contacts = { { 'base', 'block', cdem.coulomb{ friction_angle = phi } } } }\n"
    "  m:fix{ on = 'base' }\n"
    "  local a = math.rad(25)\n"
    "  m:gravity{ vector = {9.81 * math.sin(a), 0, -9.81 * math.cos(a)} }\n"
    "  return m\nend\n"
    "local exact = math.tan(math.rad(35)) / math.tan(math.rad(25))\n";

// Lua that asserts that the names in a table are those of the module's record.
std::string has_fields_of(const std::string& table, const std::string& record) {
  std::string declared;
  for (const RecordType& type : module().records)
    if (type.name == record)
      for (const Field& field : type.fields)
        declared += field.name + " = true, ";
  return "for name in pairs(" + table + ") do assert(({ " + declared + "})[name], name) end\n" +
         "for name in pairs{ " + declared + "} do assert(" + table + "[name], name) end\n";
}

} // namespace

TEST_CASE("a relaxation answers, and the script goes on", "[lua][safety]") {
  Script script(
      safety_head +
      "local m = incline(20)\nlocal r = m:relax{}\n"
      "assert(r.verdict == 'failing' and not r.converged and r.moving > 0)\n"
      "m:picture{ file = 'failing.png' }\nm:save{ file = 'failing.vtu' }\n"
      "m = incline(35)\nr = m:relax{ residual = 1e-5 }\nassert(r.verdict == 'stable')\n"
      "m = incline(20)\nr = m:relax{ max_steps = 20, trial = 'short' }\n"
      "assert(r.verdict == 'undecided' and r.trial == 'short')\ncdem.report{ { name = 'a', value = 1 } }");
  script.run();
  CHECK(script.wrote("failing.png"));
  CHECK(script.wrote("failing.vtu"));
  const std::string report = script.read("report.json");
  CHECK_THAT(report, Contains("\"relaxations\"") && Contains("\"verdict\": \"failing\"") &&
                         Contains("\"trial\": \"short\""));
}

TEST_CASE("the factor of safety of a block on an incline is tan(phi) / tan(a)", "[lua][safety]") {
  const std::string search = "reduce = {'joints'}, lower = 0.9, upper = 2, tolerance = 0.02, residual = 1e-5";
  Script script(
      safety_head +
      "local m = incline(35)\nm:relax{ residual = 1e-5 }\nlocal before = m.state_hash\n"
      "local f = cdem.factor_of_safety{ model = m, picture = 'mechanism.png', " +
      search +
      " }\n"
      "assert(m.state_hash == before)\n"
      "assert(f.lower < exact + 0.01 and f.upper > exact - 0.01, f.lower .. ' ' .. f.upper)\n"
      "assert(f.upper - f.lower <= 0.02 and f.factor == 0.5 * (f.lower + f.upper))\n"
      "assert(#f.trials >= 7 and f.trials[1].factor == 0.9 and f.trials[1].verdict == 'stable')\n"
      "assert(f.failing:max('displacement.magnitude') > 10 * f.stable:max('displacement.magnitude'))\n"
      "local g = cdem.factor_of_safety{ builder = function() return incline(35) end, " +
      search + " }\nassert(math.abs(g.factor - f.factor) <= 0.02)");
  script.run();
  CHECK(script.wrote("mechanism.png"));
  CHECK_THAT(script.read("report.json"),
             Contains("factor_of_safety_upper") && Contains("\"trial\": \"F = 0.9\""));
}

TEST_CASE("a factor of safety tells of a trial that stands only after a long way", "[lua][safety]") {
  Script script(safety_head + R"(
local soft = cdem.elastic{ youngs_modulus = 2e6, poissons_ratio = 0.2, density = 2500 }
local function held()
  local m = cdem.model{ bodies = {
    { name = "base", shape = cdem.box{ size = {3, 1, 0.5}, origin = {-1, 0, -0.5} }, material = stone },
    { name = "block", shape = cdem.box{ size = {1, 1, 0.5} }, material = soft },
    { name = "stop", shape = cdem.box{ size = {0.4, 1, 0.5}, origin = {1.03, 0, 0.001} }, material = stone } },
    contacts = { { "base", "block", cdem.coulomb{ friction_angle = 35 } },
                 { "block", "stop", cdem.coulomb{ friction_angle = 0 } } } }
  m:fix{ on = "base" }
  m:fix{ on = "stop" }
  local a = math.rad(25)
  m:gravity{ vector = {9.81 * math.sin(a), 0, -9.81 * math.cos(a)} }
  return m
end
cdem.factor_of_safety{ builder = held, reduce = {"joints"}, lower = 1, upper = 2 })");
  CHECK_THROWS_WITH(script.run(), Contains("the model is stable there still"));
  const auto tells = [](const std::string& line) {
    return line.find("stable, but only after a way") != std::string::npos;
  };
  CHECK(std::count_if(script.listener->lines.begin(), script.listener->lines.end(), tells) == 1);
}

TEST_CASE("a factor of safety tells what fails, and passes over what is too small to count",
          "[lua][safety]") {
  // Two planes through a box, of 30 and 38 degrees: the steep one cuts off a corner that slides first, tan phi / tan dip.
  const std::string two = R"(
local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 5e9, poissons_ratio = 0.25, density = 2600 }
local function tan(degrees) return math.tan(math.rad(degrees)) end
local shape = cdem.cut_by_plane{ shape = cdem.box{ size = {4, 1, 4} }, point = {0, 0, 3}, normal = {tan(30), 0, 1} }
shape = cdem.cut_by_plane{ shape = shape, point = {3.5, 0, 3.9}, normal = {tan(38), 0, 1} }
local m = cdem.model{ bodies = { { shape = shape, material = rock, joint = cdem.coulomb{ friction_angle = 40 } } } }
m:fix{ on = "z-" }
m:gravity{ vector = {0, 0, -9.81} }
m:relax{ residual = 1e-4 }
local function search(smallest)
  return cdem.factor_of_safety{ model = m, reduce = {"joints"}, lower = 0.95, upper = 1.6, tolerance = 0.03, residual = 1e-4,
                                smallest = smallest, figure = smallest and "of_slope" or "of_all" }
end
)";
  Script script(two + R"(
local all, slope = search(), search(1)
assert(math.abs(all.factor - tan(40) / tan(38)) < 0.03, all.factor)
assert(math.abs(slope.factor - tan(40) / tan(30)) < 0.03, slope.factor)
local corner = all.mechanism
assert(#corner.blocks == 1 and all.left_out == 0 and slope.left_out == 1)
-- The corner is a triangle of (4 - x) (4 - z) / 2 with the plane through (3.5, 3.9).
local rise = 0.1 + 0.5 * tan(38)
assert(math.abs(corner.volume - 0.5 * rise ^ 2 / tan(38)) < 1e-9 and corner.largest == corner.volume)
local d = corner.displacement
assert(math.abs(-d[3] / d[1] - tan(38)) < 0.02 and math.abs(d[2]) < 1e-3 * d[1]) -- it moves along its plane
assert(slope.mechanism.volume > 5 and math.abs(-slope.mechanism.displacement[3] / slope.mechanism.displacement[1] - tan(30)) < 0.02)
)");
  script.run();
  CHECK(script.wrote("trials/history_2.csv")); // of a trial; the model's own is history.csv
  CHECK(script.wrote("history.csv"));
  CHECK_THAT(script.read("report.json"), Contains("of_all_volume") && Contains("of_slope_blocks"));
}

TEST_CASE("a small stone has the factor of safety of a large one", "[lua][safety]") {
  for (const char* size : {"0.05", "0.5"}) {
    CAPTURE(size);
    Script script(std::string("local size = ") + size + R"(
local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 10e9, poissons_ratio = 0.2, density = 2500 }
local m = cdem.model{ bodies = {
  { name = "base", shape = cdem.box{ size = {6, 6, 3}, origin = {-3, -3, -3} }, material = rock },
  { name = "block", shape = cdem.box{ size = {2, 2, 1}, origin = {-2, -1, 0} }, material = rock },
  { name = "stone", shape = cdem.box{ size = {size, size, size / 2}, origin = {1, 0, 0} }, material = rock } },
  contacts = { { "base", "block", cdem.coulomb{ friction_angle = 45 } },
               { "base", "stone", cdem.coulomb{ friction_angle = 30 } } } }
m:fix{ on = "z-" }
local a = math.rad(21)
m:gravity{ vector = {9.81 * math.sin(a), 0, -9.81 * math.cos(a)} }
assert(m:relax{ residual = 1e-5 }.verdict == "stable")
local f = cdem.factor_of_safety{ model = m, reduce = {"joints"}, lower = 1, upper = 2, tolerance = 0.02 }
local exact = math.tan(math.rad(30)) / math.tan(a)
assert(f.lower < exact + 0.01 and f.upper > exact - 0.01, f.lower .. " " .. f.upper)
)");
    CHECK(script.error() == "");
  }
}

TEST_CASE("the tables of a factor of safety have the fields that the reference lists", "[lua][safety]") {
  const std::string search = "local f = cdem.factor_of_safety{ model = incline(35), reduce = {'joints'}, "
                             "lower = 0.9, upper = 2, tolerance = 1 }\n" +
                             has_fields_of("f", "FactorOfSafety") + has_fields_of("f.mechanism", "Mechanism");
  CHECK(error_of(safety_head + search + has_fields_of("f.trials[1]", "SafetyTrial")) == "");
  Script checked(safety_head + search);
  checked.settings.check_only = true;
  CHECK(checked.error() == "");
}

TEST_CASE("a factor of safety says what it lacks", "[lua][safety]") {
  const auto search = [](const std::string& more) {
    return error_of(safety_head + "local m = incline(35)\ncdem.factor_of_safety{ " + more + " }");
  };
  CHECK_THAT(search("reduce = {'joints'}"), Contains("model, builder: give one of them"));
  CHECK_THAT(search("model = m"), Contains("reduce: missing"));
  CHECK_THAT(search("model = m, reduce = {'joint'}"), Contains("reduce[1]") && Contains("joints"));
  CHECK_THAT(search("model = m, reduce = {'blocks'}"), Contains("no body of the model has a plasticity"));
  CHECK_THAT(search("model = m, reduce = {'joints'}, lower = 2, upper = 1"),
             Contains("upper = 1: must be above lower = 2"));
  CHECK_THAT(search("model = m, reduce = {'joints'}, lower = 1, upper = 1.1, tolerance = 0.2"),
             Contains("tolerance = 0.2"));
  CHECK_THAT(search("model = m, reduce = {'joints'}, smallest = 1e3"),
             Contains("smallest = 1000: must be below the volume of the model"));
  CHECK_THAT(search("model = m, reduce = {'joints'}, lower = 1.8, upper = 3"),
             Contains("case.lua:") && Contains("lower = 1.8: the model is failing there already"));
  CHECK_THAT(search("model = m, reduce = {'joints'}, lower = 0.5, upper = 1.2"),
             Contains("upper = 1.2: the model is stable there still"));
  CHECK_THAT(search("model = incline(0), reduce = {'joints'}"), Contains("no strength to reduce"));
}

TEST_CASE("a script with a factor of safety can be checked", "[lua][safety]") {
  Script script(safety_head +
                "local m = incline(35)\n"
                "local f = cdem.factor_of_safety{ model = m, reduce = {'joints'}, picture = 'a.png' }\n"
                "f.failing:picture{ file = 'b.png' }\nassert(#f.trials == 0 and #f.mechanism.blocks == 0)");
  script.settings.check_only = true;
  CHECK(script.error() == "");
}

TEST_CASE("a search from a model that has run away is warned of", "[lua][safety]") {
  const auto warned = [](const std::string& before) {
    Script script(
        safety_head + before +
        "cdem.factor_of_safety{ model = m, reduce = {'joints'}, lower = 0.5, upper = 2, tolerance = 1 }");
    CHECK(script.error() == "");
    int lines = 0;
    for (const std::string& line : script.listener->lines)
      lines += line.find("factor_of_safety: model: it ran away in stage") != std::string::npos ? 1 : 0;
    return lines;
  };
  CHECK(warned("local m = incline(20)\nm:relax{}\n") == 1);
  CHECK(warned("local m = incline(20)\nm:relax{}\nm = m:copy()\n") == 1);
  CHECK(warned("local m = incline(20)\nlocal c = m:copy()\nc:relax{}\n") == 0);
  CHECK(warned("local m = incline(35)\nm:relax{ residual = 1e-5 }\n") == 0);
}

TEST_CASE("a copy of a model goes its own way", "[lua][safety]") {
  CHECK_THAT(error_of(safety_head + "local m = incline(35)\nm:relax{ residual = 1e-5 }\nlocal c = m:copy()\n"
                                    "assert(c.state_hash == m.state_hash)\n"
                                    "c:reduce_strength{ factor = 2, reduce = {'joints'} }\n"
                                    "assert(c:relax{ trial = 'half' }.verdict == 'failing')\n"
                                    "assert(m:relax{ residual = 1e-5 }.verdict == 'stable')"),
             Equals(""));
}

TEST_CASE("plasticity of blocks and of regions", "[lua][safety]") {
  const std::string soil = safety_head + "local soil = cdem.plastic{ cohesion = 1e4, friction_angle = 20, "
                                         "tensile_strength = 1e3 }\n";
  CHECK_THAT(error_of(soil +
                      "assert(soil.friction_angle == 20 and soil.dilation_angle == 0)\n"
                      "cdem.model{ bodies = { { shape = cdem.box{ size = {1, 1, 1} }, material = stone, "
                      "plasticity = soil } } }"),
             Equals(""));
  CHECK_THAT(error_of(soil +
                      "cdem.model{ bodies = { { shape = cdem.box{ size = {1, 1, 1} }, material = stone, "
                      "plasticity = soil, element = 'small_strain' } } }"),
             Contains("plasticity") && Contains("moves far"));
  CHECK_THAT(error_of(soil +
                      "cdem.model{ bodies = { { shape = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, "
                      "1} }, material = stone, region_plasticity = { { 2, soil } } } } }"),
             Contains("region_plasticity = 2"));
  CHECK_THAT(error_of(safety_head +
                      "cdem.plastic{ cohesion = 1e4, friction_angle = 20, tensile_strength = 0, "
                      "residual_cohesion = 0 }"),
             Contains("softening_strain: goes together"));
}
