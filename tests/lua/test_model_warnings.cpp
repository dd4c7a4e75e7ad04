// What a script is warned of that its model can do and hardly anybody means: records of what is held, water that reaches
// nothing, stress above the rock, forces of an excavation that are still kept.
#include "tests/lua/script.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

// The only warning with these words; "" where there is none.
std::string the_warning(const std::string& script, const std::string& words) {
  std::string found;
  for (const std::string& line : warnings_of(script))
    if (line.find(words) != std::string::npos) {
      CHECK(found.empty());
      found = line;
    }
  return found;
}

// The same in a check.
std::string checked(const std::string& text, const std::string& words) {
  Script script(text);
  script.settings.check_only = true;
  script.run();
  for (const std::string& line : script.listener->lines)
    if (line.find(words) != std::string::npos)
      return line;
  return "";
}

// A rigid floor and a cube of 0.4 m that stands a millimetre above it.
const std::string floor_and_units =
    "local cdem = require 'cdem'\n"
    "local rock = cdem.elastic{ youngs_modulus = 1e8, poissons_ratio = 0.2, density = 2000 }\n"
    "local cube = cdem.solid.box{ size = {0.4, 0.4, 0.4}, origin = {0.2, 0.8, 0.001} }:mesh{ size = 0.4 }\n"
    "local model = cdem.model{ bodies = {\n"
    "  { shape = cdem.solid.box{ size = {2, 2, 0.5}, origin = {0, 0, -0.5} }:mesh{ size = 2 }, material "
    "= rock, "
    "name = 'floor', element = 'rigid' },\n"
    "  { shape = cube, material = rock, name = 'units', element = 'rigid' } },\n"
    "  contacts = { default = cdem.coulomb{ friction_angle = 40 } } }\n"
    "model:fix{ on = 'floor' }\nmodel:gravity{ vector = {0, 0, -9.81} }\n";
const std::string run = "model:run{ steps = 3 }\n";

const std::string block = column("{4, 1, 4}", "{4, 1, 4}");

} // namespace

TEST_CASE("a value on a face that two bodies share is told of with the body that it is of", "[lua]") {
  const std::string two = R"(local cdem = require 'cdem'
local rock = cdem.elastic{ youngs_modulus = 1e8, poissons_ratio = 0.2, density = 2000 }
local model = cdem.model{ bodies = {
  { name = 'below', shape = cdem.box{ size = {1, 1, 1} }, material = rock },
  { name = 'above', shape = cdem.box{ size = {1, 1, 1}, origin = {0, 0, 1} }, material = rock } },
  contacts = { default = cdem.coulomb{ friction_angle = 40 } } }
)";
  const std::string words = "lies in two bodies";
  const auto asked = [&](const std::string& z) {
    return two + "model:probe{ name = 'p', field = 'stress.zz', at = {0.5, 0.4, " + z + "} }\n";
  };
  CHECK_THAT(
      the_warning(asked("1"), words),
      Contains("probe \"p\": (0.5, 0.4, 1) m lies in two bodies, \"below\" and \"above\": the value is that "
               "of \"below\""));
  CHECK(the_warning(asked("0.99"), words).empty());
  CHECK_THAT(the_warning(two + "model:at('displacement.z', {0.5, 0.4, 1})\n", words),
             Contains("at \"displacement.z\""));
}

TEST_CASE("what is recorded of a body that is held still is told of, at run and in a check", "[lua]") {
  const auto told = [&](const std::string& record, const std::string& words) {
    const std::string script = floor_and_units + record + "\n" + run;
    CHECK_THAT(checked(script, words), Contains(words));
    return the_warning(script, words);
  };
  const std::string held = "a fix holds";
  CHECK_THAT(told("model:watch{ body = 'floor', leaves = 0.2 }", held),
             Contains("case.lua:11: warning: watch of \"floor\": a fix holds all its units still"));
  CHECK_THAT(
      told("model:probe{ name = 'foot', field = 'displacement.z', at = {1, 1, -0.2} }", held),
      Contains("probe \"foot\": a fix holds the rock at (1, 1, -0.2) m still: displacement.z never changes"));
  CHECK_THAT(told("model:record_momentum{ name = 'p', body = 'floor' }", held),
             Contains("record_momentum \"p\": a fix holds \"floor\" still"));
  CHECK_THAT(told("model:record_reaction{ name = 'r', on = 'units' }", "nothing holds"),
             Contains("record_reaction \"r\": nothing holds \"units\": its reaction is 0"));
  CHECK(the_warning(floor_and_units +
                        "model:watch{ body = 'units', leaves = 0.2 }\n"
                        "model:probe{ name = 'a', field = 'displacement.z', at = {0.4, 1, 0.2} }\n"
                        "model:record_momentum{ name = 'p', body = 'units' }\n"
                        "model:record_reaction{ name = 'r', on = 'floor' }\n" +
                        run,
                    "hold")
            .empty());
  // A support that moves is not held still.
  CHECK(the_warning(floor_and_units +
                        "model:fix{ on = 'floor', velocity = {0.1, 0, 0} }\n"
                        "model:record_momentum{ name = 'p', body = 'floor' }\n" +
                        run,
                    held)
            .empty());
}

TEST_CASE("a probe at a held face is told of for displacement, and not for stress", "[lua]") {
  const auto told = [](const std::string& field) {
    return !the_warning(column() +
                            "model:traction{ on = 'x+', stress = {1e6, 0, 0} }\n"
                            "model:probe{ name = 'a', field = '" +
                            field + "', at = {0, 0.4, 0.4} }\nmodel:relax{ max_steps = 500 }",
                        "never changes")
                .empty();
  };
  CHECK(told("displacement.x"));
  CHECK_FALSE(told("stress.xx"));
}

TEST_CASE("an initial stress whose surface lies below the rock is told of", "[lua]") {
  const auto told = [](const std::string& more) {
    return the_warning(block + "model:initial_stress{ gradient = 25e3, k0 = 0.5" + more + " }",
                       "lies below all rock");
  };
  CHECK_THAT(told(", surface = -3"),
             Contains("initial_stress: surface = -3 m lies below all rock of the place") &&
                 Contains("from z = 0 to 4 m"));
  CHECK_THAT(told(", surface = 1.9, on = function(x, y, z) return z > 2 end"), Contains("from z = 2 to 4 m"));
  CHECK(told(", surface = 2").empty());
  CHECK(told(", surface = 300").empty());
  CHECK(told("").empty());
}

TEST_CASE("faces between rock with and without initial stress are told of, at run and in a check", "[lua]") {
  const std::string layer = "model:initial_stress{ gradient = 25e3, k0 = 0.5, on = function(x, y, z) return ";
  const auto script = [&](const std::string& layers) {
    return block + layers + "model:gravity{ vector = {0, 0, -9.81} }\nmodel:relax{ max_steps = 5 }";
  };
  const std::string words = "blocks with initial stress and blocks without";
  const std::string gap = script(layer + "z > 2 end }\n" + layer + "z < 1 end }\n");
  CHECK_THAT(the_warning(gap, words), Contains("initial_stress: 8 faces of body \"column\"") &&
                                          Contains("give one to the blocks on both sides"));
  CHECK_THAT(checked(gap, words), Contains("8 faces"));
  CHECK(the_warning(script(layer + "z > 2 end }\n" + layer + "z < 2 end }\n"), words).empty());
  CHECK(the_warning(script(""), words).empty());
}

TEST_CASE("an initial stress that jumps between layers is told of, at run and in a check", "[lua]") {
  const auto script = [&](const std::string& lower) {
    return block +
           "model:initial_stress{ gradient = 25e3, k0 = 0.5, on = function(x, y, z) return z > 2 end }\n"
           "model:initial_stress{ k0 = 0.8, on = function(x, y, z) return z < 2 end, " +
           lower + " }\nmodel:gravity{ vector = {0, 0, -9.81} }\nmodel:relax{ max_steps = 5 }";
  };
  const std::string words = "jumps at a face between two layers";
  const std::string jump = script("gradient = 25e3, surface = 2");
  CHECK_THAT(the_warning(jump, words),
             Contains("5e+04 Pa") && Contains(", 2) m") && Contains("weight of the upper"));
  CHECK_THAT(checked(jump, words), Contains("5e+04 Pa"));
  // Horizontal stress may differ.
  CHECK(the_warning(script("gradient = 25e3"), words).empty());
  CHECK(the_warning(script("gradient = 30e3, surface = 2, stress = {-4e4, -4e4, -5e4, 0, 0, 0}"), words)
            .empty());
}

TEST_CASE("a profile of a water table that ends before the model is told of", "[lua]") {
  const auto told = [](const std::string& more) {
    return the_warning(block + "local t = cdem.water_table{ profile = { {0, 1}, {10, 3} }" + more +
                           " }\nmodel:water{ water_table = t }",
                       "its profile");
  };
  CHECK_THAT(
      told(", origin = {500, 0, 0}"),
      Contains(
          "water_table: its profile has distances from 0 to 10 m, and the model lies at -500 to -496 m") &&
          Contains("level there, at z = 1 m"));
  CHECK_THAT(told(", direction = {0, 1, 0}, origin = {0, -20, 0}"),
             Contains("at 20 to 21 m") && Contains("z = 3 m"));
  CHECK(told("").empty());
  CHECK(told(", origin = {3, 0, 0}").empty());
}

TEST_CASE("water that reaches no face in any run is told of at the end, and in a check", "[lua]") {
  const auto script = [](const std::string& water) {
    return floor_and_units + "model:flow{ on = 'units', water = cdem.water." + water +
           " }\nmodel:run{ duration = 0.01 }\nmodel:run{ duration = 0.02 }";
  };
  const std::string dry = script("uniform{ velocity = {1, 0, 0}, level = -3 }");
  const std::string words = "its water reached no face";
  CHECK_THAT(the_warning(dry, words),
             Contains("warning: model 1: flow on body \"units\": its water reached no face "
                      "from t = 0 to 0.03") &&
                 Contains("it rose to z = -3 m"));
  CHECK_THAT(checked(dry, words),
             Contains("from t = 0 to 0.03 s") && Contains("the lowest face is at z = 0.001 m"));
  CHECK(the_warning(script("uniform{ velocity = {1, 0, 0}, level = 0.01 }"), words).empty());
  CHECK(the_warning(script("uniform{ velocity = {1, 0, 0} }"), words).empty());
  // It comes in the second run.
  CHECK(the_warning(
            script("field{ velocity = function() return {0, 0, 0} end, surface = function(x, y, z, t) return "
                   "t > 0.02 and 1 or -1 end }"),
            words)
            .empty());
}

TEST_CASE("a check tries functions of time over the run, one after the other", "[lua]") {
  const auto error = [](const std::string& load) {
    Script script(floor_and_units + load +
                  "\nmodel:run{ duration = 2 }\nassert(model.time == 2)\n"
                  "model:run{ duration = 3 }\n");
    script.settings.check_only = true;
    return script.error();
  };
  const std::string turning = "model:gravity{ vector = function(t) return ";
  CHECK_THAT(error(turning + "{0, 0, -math.sqrt(4 - t)} end }"),
             Contains("case.lua:13: model:run: vector(4.1) of case.lua:10") &&
                 Contains("three finite numbers"));
  CHECK(error(turning + "{0, 0, -math.sqrt(5 - t)} end }").empty());
  CHECK_THAT(
      error("model:flow{ on = 'units', direction = {1, 0, 0}, velocity = function(t) return 1 - t end }"),
      Contains("velocity(1.2) of case.lua:10") && Contains("a finite number >= 0 m/s"));
  CHECK_THAT(
      error(
          "model:force{ on = 'units', force = {1, 0, 0}, amplitude = function(t) return t > 4.9 and {} or 1 "
          "end }"),
      Contains("amplitude(5) of case.lua:10"));
}

TEST_CASE("a check asks the water of a flow at times of each run", "[lua]") {
  const auto error = [](const std::string& water) {
    Script script(floor_and_units + "model:flow{ on = 'units', water = cdem.water." + water +
                  " }\nmodel:run{ duration = 1 }");
    script.settings.check_only = true;
    return script.error();
  };
  CHECK_THAT(error("uniform{ velocity = function(t) return t < 0.5 and {1, 0, 0} or nil end }"),
             Contains("case.lua:11: model:run: velocity(0.5"));
  CHECK_THAT(error("field{ velocity = function(x, y, z, t) return t < 0.5 and {1, 0, 0} or nil end }"),
             Contains("case.lua:11: model:run: velocity("));
  CHECK(error("uniform{ velocity = function(t) return {1 - t, 0, 0} end }").empty());
}

TEST_CASE("water that stands above a floor dug later is told of", "[lua]") {
  const std::string dug = block + "model:fix{ on = 'z-' }\nmodel:gravity{ vector = {0, 0, -9.81} }\n"
                                  "model:water{ level = 3.9 }\nmodel:relax{ max_steps = 5 }\n"
                                  "model:remove{ on = function(x, y, z) return x > 2 and z > 1 end }\n";
  const std::string words = "stands above 2 m2 of open ground, up to 2.9 m",
                    relax = "model:relax{ max_steps = 5 }";
  CHECK_THAT(the_warning(dug + relax, words), Contains("level = 3.9 m"));
  CHECK_THAT(checked(dug + relax, words), Contains("case.lua:12: warning"));
  CHECK(the_warning(dug + "model:water{ level = 1 }\n" + relax, words).empty());
}

TEST_CASE("waves for a flat bed over ground that rises are told of", "[lua]") {
  const std::string words = "its waves keep their shape over a flat bed";
  const auto script = [](const std::string& floor, const std::string& water) {
    std::string text = floor_and_units;
    const std::string flat = "cdem.solid.box{ size = {2, 2, 0.5}, origin = {0, 0, -0.5} }";
    text.replace(text.find(flat), flat.size(), flat + floor);
    return text + "model:flow{ on = 'units', water = cdem.water." + water + " }\nmodel:run{ steps = 3 }\n";
  };
  const std::string slope = ":rotate{ axis = {0, 1, 0}, angle = -20 }:translate{ shift = {0, 0, -0.6} }",
                    wave = "wave{ height = 0.1, period = 3, level = 1, depth = 1 }",
                    sea = "sea{ significant_height = 0.1, peak_period = 3, level = 1, depth = 3 }";
  CHECK_THAT(the_warning(script(slope, wave), words), Contains("flow on body \"units\"") &&
                                                          Contains("a flat bed at z = 0 m") &&
                                                          Contains("cdem.water.slope"));
  CHECK_THAT(checked(script(slope, wave), words), Contains("case.lua:11: warning: flow on"));
  CHECK_THAT(the_warning(script("", sea), words), Contains("a flat bed at z = -2 m"));
  CHECK(the_warning(script("", wave), words).empty());
  CHECK(the_warning(script(slope, "uniform{ velocity = {1, 0, 0}, level = 1 }"), words).empty());
}

TEST_CASE("waves that are short for the shallow water of a slope are told of", "[lua][water]") {
  const auto script = [](const std::string& waves) {
    return opening + "cdem.water.slope{ bed = { {0, -10}, {10, -10}, {40, 10} }, duration = 1, waves = " +
           "cdem.water." + waves + " }\n";
  };
  const std::string words = "k d = ";
  // omega^2 d / g = 4.471 = k d tanh(k d) gives k d = 4.473, and 1 / cosh of it .0228.
  CHECK_THAT(the_warning(script("wave{ height = 0.01, period = 3, depth = 10, theory = 'airy' }"), words),
             Contains("k d = 4.5 ") && Contains("have 0.023 of their velocity"));
  CHECK(!the_warning(script("sea{ significant_height = 0.2, peak_period = 5, depth = 10 }"), words).empty());
  CHECK(the_warning(script("wave{ height = 0.5, period = 9, depth = 10 }"), words).empty());
}

TEST_CASE("a check tells of a factor of safety that the fall of one small block decides", "[lua]") {
  const auto summary = [](const std::string& more) {
    Script script(column("{6, 5, 6}", "{6, 5, 6}") +
                  "model:gravity{ vector = {0, 0, -9.81} }\nmodel:relax{}\n"
                  "cdem.factor_of_safety{ model = model, reduce = {'joints'}" +
                  more + " }");
    script.settings.check_only = true;
    script.run();
    return script.engine->model_summary();
  };
  CHECK_THAT(summary(""),
             Contains("factor_of_safety without smallest (m3): the fall of one block decides it, "
                      "the smallest of 1 m3 too, where the model has 180 m3"));
  CHECK_THAT(summary(", smallest = 0"), !Contains("without smallest"));
}

TEST_CASE("forces of an excavation that are still kept are told of at the end and by a reduction of strength",
          "[lua]") {
  const std::string dug =
      block + "model:fix{ on = 'z-' }\nmodel:gravity{ vector = {0, 0, -9.81} }\n"
              "model:relax{ max_steps = 20000 }\n"
              "model:remove{ on = function(x, y, z) return x > 2 and z > 1 end, relaxed = 0.4 }\n";
  const std::string relax = "model:relax{ max_steps = 20000 }\n";
  const std::string words = "still kept in its last stage";
  CHECK_THAT(
      the_warning(dug + relax, words),
      Contains(
          "model 1: forces of an excavation were still kept in its last stage, up to 0.6 of their size"));
  CHECK(the_warning(dug + relax + "model:relax_excavation{}\n" + relax, words).empty());
  CHECK_THAT(the_warning(dug + relax + "model:copy():reduce_strength{ factor = 1.2, reduce = {'joints'} }",
                         "reduce_strength"),
             Contains("forces of an excavation are kept, up to 0.6 of their size") &&
                 Contains("a factor of safety counts on them"));
}

TEST_CASE("the report holds what a model warns of, with its place", "[lua]") {
  Script script(floor_and_units + "model:watch{ body = 'floor', leaves = 0.2 }\n" + run +
                "cdem.report{ { name = 'a', value = 1 } }");
  script.run();
  CHECK_THAT(script.read("report.json"), Contains("case.lua:11: warning: watch of \\\"floor\\\""));
}

TEST_CASE("measures of a pile that is too small are nil, with one warning, its contacts are told", "[lua]") {
  const std::string script = floor_and_units +
                             "local m = model:pile_measures{ body = 'units', onto = 'floor' }\n"
                             "assert(m.porosity == nil and m.thickness == nil)\n"
                             "assert(#m.contacts == 1 and m.fewest_contacts == 0)\n";
  CHECK_THAT(the_warning(script, "pile_measures"), Contains("the pile has no middle") &&
                                                       Contains("at least three rows of three") &&
                                                       Contains("porosity, density and thickness are nil"));
}

TEST_CASE("the reaction of a held rigid body holds its weight and what leans on it", "[lua]") {
  // 2 m3 and 0.064 m3 of 2000 kg/m3.
  const std::string script = floor_and_units +
                             "local own = model:reaction('floor')[3]\n"
                             "assert(math.abs(own - 2 * 2000 * 9.81) < 1e-6 * own, own)\n"
                             "assert(model:settle{}.converged)\n"
                             "local both = model:reaction('floor')[3]\n"
                             "assert(math.abs(both - 2.064 * 2000 * 9.81) < 1e-3 * both, both)";
  CHECK(error_of(script) == "");
}

TEST_CASE("a check tells of a probe in rock that is dug later, and of many units that deform", "[lua]") {
  CHECK_THAT(checked(block + "model:probe{ name = 'wall', field = 'displacement.z', at = {3.5, 0.5, 3.5} }\n"
                             "model:gravity{ vector = {0, 0, -9.81} }\nmodel:relax{}\n"
                             "model:remove{ on = function(x, y, z) return x > 3 and z > 3 end }\n",
                     "was removed"),
             Contains("case.lua:10: warning: probe \"wall\": the rock at (3.5, 0.5, 3.5) m was removed"));
  const auto summary = [](const std::string& element) {
    Script script("local cdem = require 'cdem'\n"
                  "local rock = cdem.elastic{ youngs_modulus = 1e8, poissons_ratio = 0.2, density = 2000 }\n"
                  "local floor = cdem.box_mesh{ size = {9, 9, 1}, divisions = {1, 1, 1} }\n"
                  "local pile = cdem.drop{ unit = cdem.cube{ height = 0.4 }:mesh{ size = 0.1 }, count = 25, "
                  "onto = floor }\n"
                  "cdem.model{ bodies = { { shape = floor, material = rock, element = 'rigid' },\n"
                  "  { shape = pile, material = rock, name = 'units', element = '" +
                  element + "' } } }");
    script.settings.check_only = true;
    script.run();
    return script.engine->model_summary();
  };
  CHECK_THAT(summary("finite_volume"), Contains("\"units\": 25 units deform, with ") &&
                                           Contains("and cannot break") && Contains("takes steps some ") &&
                                           Contains(" times as long and computes no tets"));
  CHECK_THAT(summary("rigid"), !Contains("units deform"));
}
