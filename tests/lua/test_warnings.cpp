// What a script is warned of, and where the warnings go.
#include "tests/lua/script.hpp"

#include "libcdem/step/errors.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <iterator>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

const std::string pull = "model:traction{ on = 'x+', stress = {1e6, 0, 0} }\n";

} // namespace

TEST_CASE("a relaxation that does not converge warns and says so in its result", "[lua]") {
  const auto warnings = warnings_of(column() + pull + "assert(not model:relax{ max_steps = 5 }.converged)");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("case.lua:8: warning: relax: undecided after 5 steps, residual ") &&
                              Contains("not converged"));
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
             Contains("cdem.coulomb: friction_angle = 0.52: is it in degrees? Rock has 20 to 50"));
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
TEST_CASE("a value that looks like one in another unit is told of, in every call that takes it", "[lua]") {
  const auto of = [](const std::string& call) {
    const auto warnings = warnings_of("local cdem = require 'cdem'\n" + call);
    return warnings.size() == 1 ? warnings[0] : std::to_string(warnings.size()) + " warnings";
  };
  CHECK_THAT(of("cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2.4 }"),
             Contains("case.lua:2: warning: cdem.elastic: density = 2.4: is it in kg/m3? Rock has"));
  for (const std::string unit : {"cube", "antifer", "tetrapod", "accropode", "dolos", "cubipod"}) {
    CHECK_THAT(of("cdem." + unit + "{ mass = 3, density = 2400 }"),
               Contains("cdem." + unit + ": mass = 3: is it in kg?"));
    CHECK_THAT(of("cdem." + unit + "{ mass = 3000, density = 2.4 }"),
               Contains("cdem." + unit + ": density = 2.4: is it in kg/m3?"));
    CHECK(warnings_of("local cdem = require 'cdem'\ncdem." + unit + "{ mass = 0.1, density = 2300 }\ncdem." +
                      unit + "{ mass = 3000, density = 2400 }\ncdem." + unit + "{ height = 0.12 }")
              .empty());
  }
  const std::string bond = "cohesion = 1e6, friction_angle = 30, tensile_strength = 1e6";
  CHECK_THAT(of("cdem.mohr_coulomb{ cohesion = 1e6, friction_angle = 30, tensile_strength = 5 }"),
             Contains("tensile_strength = 5: is it in Pa?"));
  CHECK_THAT(of("cdem.mohr_coulomb{ " + bond +
                ", softening = 'linear', fracture_energy_1 = 0.1, fracture_energy_2 = 1e3 }"),
             Contains("fracture_energy_1 = 0.1: is it in J/m2?"));
  CHECK_THAT(of("cdem.mohr_coulomb{ " + bond + ", normal_stiffness = 5e3 }"),
             Contains("normal_stiffness = 5000: is it in Pa/m?"));
  CHECK_THAT(of("cdem.coulomb{ friction_angle = 40, residual_friction_angle = 0.5 }"),
             Contains("residual_friction_angle = 0.5: is it in degrees?"));
  CHECK_THAT(of("cdem.plastic{ " + bond + ", residual_cohesion = 3, softening_strain = 0.01 }"),
             Contains("residual_cohesion = 3: is it in Pa?"));
  CHECK_THAT(of("cdem.hoek_brown{ sigma_ci = 80, gsi = 60, m_i = 10 }"),
             Contains("sigma_ci = 80: is it in Pa?"));
  CHECK_THAT(of("cdem.flow_pressure(3, 1.025)"), Contains("water_density = 1.025: is it in kg/m3?"));
  CHECK_THAT(of("cdem.water.uniform{ velocity = {1, 0, 0}, density = 1 }"),
             Contains("cdem.water.uniform: density = 1: is it in kg/m3?"));
  CHECK_THAT(of(column() + "model:traction{ on = 'x+', level = 0.5, weight = 1000 }"),
             Contains("traction: weight = 1000: is it in N/m3?"));
  CHECK_THAT(of(column() + "model:gravity{ vector = {0, 0, -9810} }"),
             Contains("gravity: vector = {0, 0, -9810}: is it in m/s2? On Earth"));
  CHECK_THAT(of(column() + "model:gravity{ vector = {0, 0, 9.81} }"), Contains("it pulls upwards"));
  CHECK_THAT(of(column() + "model:gravity{ vector = {1, 9.81, 0} }"), Contains("it pulls upwards"));
  const std::string bolt =
      column() + "model:bolts{ from = {0, 0.5, 0.5}, to = {1.5, 0.5, 0.5}, area = 5e-4, ";
  CHECK_THAT(of(bolt + "yield_stress = 500 }"),
             Contains("model:bolts: yield_stress = 500: is it in Pa? Steel"));
  CHECK_THAT(of(bolt + "grout_strength = 200 }"), Contains("grout_strength = 200: is it in N/m?"));
  CHECK_THAT(of(bolt + "plate = true, pretension = 100 }"), Contains("pretension = 100: is it in N?"));
  CHECK(warnings_of(bolt + "yield_stress = 500e6, grout_strength = 2e5, pretension = 1e5, plate = true }")
            .empty());
}

TEST_CASE("an old name of a field is taken with a warning, both names are refused", "[lua]") {
  const std::string bond = "require('cdem').mohr_coulomb{ cohesion = 1e6, friction_angle = 30, "
                           "tensile_strength = 1e6, residual_cohesion = 1e5, residual_tension = 2e5";
  const auto warnings = warnings_of("assert(tostring(" + bond + " }):find('tension 2e+05 Pa', 1, true))");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0],
             Contains("cdem.mohr_coulomb: residual_tension is named residual_tensile_strength now; "
                      "the next release no longer knows the old name"));
  CHECK_THAT(
      error_of(bond + ", residual_tensile_strength = 2e5 }"),
      Contains("residual_tension and residual_tensile_strength: the same; give residual_tensile_strength"));
}

TEST_CASE("an object under a wrong name is told its own", "[lua]") {
  const std::string table = column() + "local table = cdem.water_table{ profile = { {0, 0.5}, {2, 0.5} } }\n";
  CHECK_THAT(error_of(table + "model:water{ table = table }"),
             Contains("model:water: table = cdem.WaterTable: must be a list") &&
                 Contains("write water_table = for it"));
  CHECK_THAT(error_of(table + "model:water{ level = table }"), Contains("write water_table = for it"));
  CHECK_THAT(error_of(column() + "cdem.model{ bodies = { { shape = cdem.box{ size = {1, 1, 1} }, "
                                 "material = joint } } }"),
             Contains("bodies[1].material = cdem.Joint") && Contains("write joint = for it"));
}

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

TEST_CASE("slivers are told of before a stage in real time, once, and not where they cost nothing", "[lua]") {
  const auto told = [](const std::string& element, const std::string& stages) {
    return those_with(
        warnings_of("local cdem = require 'cdem'\n"
                    "local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, "
                    "density = 2000 }\n"
                    "local joint = cdem.coulomb{ friction_angle = 40 }\n"
                    "local function box(x, y) return cdem.box{ size = {x, 1, 1}, origin = {y, 0, 0} } end\n"
                    "local shape = cdem.merge{ shapes = { box(1, 0), box(1, 2), box(1, 4), box(0.01, 6) } }\n"
                    "local model = cdem.model{ bodies = { { shape = shape, material = rock, joint = joint, "
                    "name = 'plates', element = '" +
                    element +
                    "' } } }\n"
                    "model:gravity{ vector = {0, 0, -9.81} }\n" +
                    stages),
        "need a time step");
  };
  const std::string run = "model:run{ steps = 3, time_step = 1e-7 }\n";
  const auto warnings = told("finite_volume", run + run);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("1 of 4 blocks of \"plates\" need a time step of ") &&
                              Contains("The worst is block 4 at (6.005, 0.5, 0.5) m") &&
                              Contains("element = \"rigid\""));
  CHECK(told("rigid", run).empty());
  CHECK(told("finite_volume", "").empty());
}

// Rigid cubes that meet face on at this speed: at the longest time step that is taken their impact takes three steps.
TEST_CASE(
    "an energy balance that is open is told of with its likely cause, and ends the run when it is wide open",
    "[lua]") {
  const auto at = [](const std::string& speed) {
    return "local cdem = require 'cdem'\n"
           "local rock = cdem.elastic{ youngs_modulus = 1e8, poissons_ratio = 0.2, density = 2000 }\n"
           "local function cube(x, name) return { shape = cdem.box{ size = {0.4, 0.4, 0.4}, origin = {x, 0, "
           "0} }, "
           "material = rock, name = name, element = 'rigid' } end\n"
           "local model = cdem.model{ bodies = { cube(0, 'a'), cube(0.41, 'b') }, "
           "contacts = { default = cdem.coulomb{ friction_angle = 40 } } }\n"
           "model:initial_velocity{ on = 'a', velocity = {" +
           speed +
           ", 0, 0} }\n"
           "model:run{ duration = 0.04, time_step = 2.2e-4 }\nmodel:run{ duration = 0.01, time_step = 2.2e-4 "
           "}";
  };
  const auto warnings = warnings_of(at("0.5"));
  REQUIRE(warnings.size() == 1); // once, not after each stage
  CHECK_THAT(warnings[0], Contains("stage 1 (run): the energy balance is open by 1.8") &&
                              Contains("J lost, more than 1 %); most likely from contacts"));
  Script script(at("0.45"));
  try {
    script.run();
    FAIL("the run went on");
  } catch (const cdem::SolutionError& error) {
    CHECK_THAT(error.what(), Contains("the energy balance is open by 19.8") &&
                                 Contains("J gained); most likely from contacts") &&
                                 Contains("take a smaller safety"));
  }
}

TEST_CASE("a relaxation that is cut short tells of a stone that slides where the model is in balance",
          "[lua][stability]") {
  const auto warnings = warnings_of(R"(
local cdem = require 'cdem'
local rock = cdem.elastic{ youngs_modulus = 1e10, poissons_ratio = 0.2, density = 2500 }
local function box(name, size, x)
  return { name = name, shape = cdem.box{ size = {size, size, size / 2}, origin = {x, 0, 0} }, material = rock }
end
local model = cdem.model{
  bodies = { { name = 'base', material = rock, shape = cdem.box{ size = {6, 6, 3}, origin = {-3, -3, -3} } },
             box('block', 2, -2), box('stone', 0.2, 1) },
  contacts = { {'base', 'block', cdem.coulomb{ friction_angle = 30 }},
               {'base', 'stone', cdem.coulomb{ friction_angle = 10 }} } }
model:fix{ on = 'z-' }
local a = math.rad(21)
model:gravity{ vector = {9.81 * math.sin(a), 0, -9.81 * math.cos(a)} }
assert(model:relax{ residual = 1e-5, max_steps = 1000 }.verdict == 'undecided'))");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0],
             Contains("the model as a whole is in balance, but not each of its pieces: block 3 at"));
}

TEST_CASE("a second load on a place adds to the first, and that is told", "[lua]") {
  const std::string push = "model:force{ on = 'x+', force = {1, 0, 0} }\n";
  const auto warnings = warnings_of(column() + pull + pull + push + push);
  REQUIRE(warnings.size() == 2);
  CHECK_THAT(warnings[0], Contains("traction: it acts on faces that an earlier traction already loads"));
  CHECK_THAT(warnings[1], Contains("force: it acts on nodes that an earlier force already loads"));
  CHECK(warnings_of(column() + pull + push + "model:clear_loads()\n" + pull + push).empty());
}

TEST_CASE("a density that no water has is told of", "[lua]") {
  const auto in_water = [](const char* density) {
    return warnings_of(column() + "model:gravity{ vector = {0, 0, -9.81}, water_density = " + density + " }")
        .size();
  };
  CHECK(in_water("1") == 1);
  CHECK(in_water("10250") == 1);
  CHECK(in_water("1000") == 0);
  CHECK(in_water("0") == 0);
}

TEST_CASE("a joint set that makes no face is told of", "[lua]") {
  const auto of = [](const std::string& set) {
    return warnings_of("local cdem = require 'cdem'\n"
                       "cdem.cut_by_joints{ shape = cdem.box{ size = {1, 1, 1} }, smallest = 0.1, sets = { "
                       "{ name = 'bedding', dip = 0, dip_direction = 0, spacing = 0.4 }, { " +
                       set + " } } }");
  };
  CHECK(of("name = 'J', dip = 90, dip_direction = 0, spacing = 0.3").empty());
  const auto none = of("name = 'J', dip = 90, dip_direction = 0, spacing = 300, origin = {0, 0.95, 0}");
  REQUIRE(none.size() == 1);
  CHECK_THAT(none[0], Contains("set \"J\" made no face") && Contains("300 m apart"));
}

TEST_CASE("a plane that cuts nothing is told of", "[lua]") {
  const auto at = [](const std::string& height) {
    return warnings_of(
        "local cdem = require 'cdem'\n"
        "cdem.cut_by_plane{ shape = cdem.box{ size = {1, 1, 1} }, normal = {0, 0, 1}, point = {0, 0, " +
        height + "}, name = 'fault' }");
  };
  CHECK(at("0.5").empty());
  const auto missed = at("1.5");
  REQUIRE(missed.size() == 1);
  CHECK_THAT(missed[0], Contains("cut_by_plane: the plane misses the shape"));
}

TEST_CASE("dips and angles of bolts that look like radians are warned of", "[lua]") {
  const auto of = [](const std::string& dips) {
    return warnings_of("local cdem = require 'cdem'\n"
                       "cdem.cut_by_joints{ shape = cdem.box{ size = {1, 1, 1} }, sets = { " +
                       dips + " } }");
  };
  const auto radians = of("{ dip = 0.6, dip_direction = 1.5, spacing = 0.4 }");
  REQUIRE(radians.size() == 1);
  CHECK_THAT(radians[0],
             Contains("cut_by_joints: dip and dip_direction of sets") && Contains("angles are in degrees"));
  CHECK(of("{ dip = 0.6, dip_direction = 90, spacing = 0.4 }").empty());
  CHECK(of("{ dip = 0, dip_direction = 0, spacing = 0.4 }").empty());
  CHECK(of("{ dip = 1, dip_direction = 0, spacing = 0.4 }").empty());
  CHECK(of("{ dip = 0.6, dip_direction = 0, spacing = 0.4 }, { dip = 85, dip_direction = 0, spacing = 0.4 }")
            .empty());
  const auto discs =
      warnings_of("local cdem = require 'cdem'\n"
                  "cdem.cut_by_discs{ shape = cdem.box{ size = {1, 1, 1} }, discs = { { centre = "
                  "{0.5, 0.5, 0.5}, dip = 0.7, dip_direction = 3.1, radius = 2, set = 'a' } } }");
  REQUIRE(discs.size() == 1);
  CHECK_THAT(discs[0], Contains("dip and dip_direction of discs"));
  const auto bolts = [](const std::string& angles) {
    return warnings_of(column() +
                       "model:bolts{ pattern = { axis = 'y', at = {0}, centre = {0, 0, 0.4}, radius = "
                       "0.01, length = 0.1, angles = " +
                       angles + " }, area = 1e-4, youngs_modulus = 2e11, grout_stiffness = 1e9 }");
  };
  CHECK(bolts("{0, 30}").empty());
  CHECK(bolts("{0, 0.52}").size() == 1);
}

TEST_CASE("a force that a support takes is told once, one beside it is not", "[lua]") {
  const std::string foot = column() + "model:fix{ on = 'z-', axes = 'z' }\n";
  const auto warnings = warnings_of(
      foot + "model:force{ on = 'z-', force = {0, 0, 1e3} }\nmodel:force{ on = 'x+', force = {1e3, 0, 0} }\n"
             "model:relax{ max_steps = 20 }\nmodel:relax{ max_steps = 20 }");
  CHECK(std::count_if(warnings.begin(), warnings.end(), [](const std::string& line) {
          return line.find("the support takes it") != std::string::npos;
        }) == 1);
}

TEST_CASE("a probe in rock that is removed gives nan, with one warning", "[lua]") {
  const auto warnings = warnings_of(
      column("{2, 1, 2}", "{2, 1, 2}") +
      "model:fix{ on = 'z-' }\nmodel:gravity{ vector = {0, 0, -9.81} }\n"
      "model:probe{ name = 'corner', field = 'displacement.z', at = {1.5, 0.5, 1.5} }\n"
      "model:relax{ max_steps = 50 }\n"
      "model:remove{ on = function(x, y, z) return x > 1 and z > 1 end }\nmodel:relax{ max_steps = 50 }\n"
      "local row = model:history().corner\nassert(row[1] == row[1] and row[#row] ~= row[#row])");
  CHECK(std::count_if(warnings.begin(), warnings.end(), [](const std::string& line) {
          return line.find("\"corner\": the rock at (1.5, 0.5, 1.5) m was removed") != std::string::npos;
        }) == 1);
}

TEST_CASE("water above a dug floor is told, water below it and under a lake is not", "[lua]") {
  const auto told = [](const std::string& more) {
    const auto warnings = warnings_of(
        column("{4, 1, 4}", "{4, 1, 4}") +
        "model:fix{ on = 'z-' }\nmodel:remove{ on = function(x, y, z) return x > 2 and z > 1 end }\n" + more);
    return std::any_of(warnings.begin(), warnings.end(), [](const std::string& line) {
      return line.find("stands above 2 m2 of open ground, up to 2.9 m") != std::string::npos;
    });
  };
  CHECK(told("model:water{ level = 3.9 }"));
  CHECK_FALSE(told("model:water{ level = 1 }"));
  const std::string plane = "local t = cdem.water_table{ point = {3, 0, 3.9}, dip = 5, dip_direction = 0 }\n";
  CHECK_FALSE(told(plane + "model:traction{ on = 'all', water_table = t }\nmodel:water{ water_table = t }"));
  const auto sloping = warnings_of(
      column("{4, 1, 4}", "{4, 1, 4}") +
      "model:fix{ on = 'z-' }\nmodel:remove{ on = function(x, y, z) return x > 2 and z > 1 end }\n" + plane +
      "model:water{ water_table = t }");
  CHECK(std::any_of(sloping.begin(), sloping.end(), [](const std::string& line) {
    return line.find("the water_table stands above 2 m2 of open ground, up to 2.9 m") != std::string::npos &&
           line.find("traction{ on = the ground, water_table = the same }") != std::string::npos;
  }));
  CHECK_FALSE(told("model:traction{ on = 'all', level = 3.9 }\nmodel:water{ level = 3.9 }"));
}

TEST_CASE("a function of time is tried at the model's time", "[lua]") {
  Script script(column() +
                "model:fix{ on = 'x-' }\nmodel:run{ duration = 1e-4 }\nlocal start = model.time\n"
                "local least = math.huge\n"
                "model:flow{ direction = {1, 0, 0}, velocity = function(t) least = math.min(least, t) return "
                "1 + (t - start) end }\n"
                "model:force{ on = 'x+', force = {1, 0, 0}, amplitude = function(t) least = math.min(least, "
                "t) return t end }\n"
                "model:gravity{ vector = function(t) least = math.min(least, t) return {0, 0, -t} end }\n"
                "assert(least == start and start > 0)");
  CHECK(script.error() == "");
}

TEST_CASE("residual cohesion without residual tension is told", "[lua]") {
  const auto law = [](const std::string& more) {
    return warnings_of(
               "require('cdem').mohr_coulomb{ cohesion = 1e6, tensile_strength = 1e5, friction_angle = 30, "
               "residual_cohesion = 5e5" +
               more + " }")
        .size();
  };
  CHECK(law("") == 1);
  CHECK(law(", residual_tensile_strength = 0") == 0);
  CHECK(law(", residual_tensile_strength = 5e4") == 0);
}
