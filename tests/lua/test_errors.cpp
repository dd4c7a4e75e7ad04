// Every error is one line: script, line, call, field, value, what is allowed, what to do.
#include "libcdem/step/errors.hpp"
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {
const std::string errors_head = "local cdem = require 'cdem'\n";
}

TEST_CASE("an error names script, line, call, field, value and range", "[lua]") {
  CHECK(error_of(
            errors_head +
            "\nlocal rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.5, density = 2500 }") ==
        "case.lua:3: cdem.elastic: poissons_ratio = 0.5: must be in (-1, 0.5)");
  CHECK(error_of(errors_head +
                 "cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = -2500 }") ==
        "case.lua:2: cdem.elastic: density = -2500: must be > 0");
  CHECK(
      error_of(errors_head + "cdem.elastic{ young_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }") ==
      "case.lua:2: cdem.elastic: young_modulus: no such key; did you mean youngs_modulus? Allowed: "
      "youngs_modulus, "
      "poissons_ratio, density, viscosity, stiffness_damping, damping");
  CHECK_THAT(error_of(errors_head + "cdem.grid{ size = {0, 1, 1}, divisions = {1, 1, 1} }"),
             Contains("case.lua:2: cdem.grid: size[1] = 0: must be > 0"));
}

TEST_CASE("an error inside a function of the script names the line that called", "[lua]") {
  CHECK_THAT(
      error_of(errors_head +
               "local function rock(nu)\n  return cdem.elastic{ youngs_modulus = 1, poissons_ratio = nu, "
               "density = 1 }\nend\nrock(0.7)"),
      Contains("case.lua:3: cdem.elastic: poissons_ratio = 0.7"));
  CHECK_THAT(
      error_of(errors_head + "pcall(print)\nlocal ok, e = pcall(cdem.elastic, { density = 1 })\nerror(e, 0)"),
      Contains("case.lua:3: cdem.elastic: youngs_modulus: missing"));
}

TEST_CASE("an error in a required file names that file", "[lua]") {
  Script script("require 'rocks'");
  script.write("rocks.lua", errors_head + "return cdem.elastic{}");
  CHECK_THAT(script.error(), Contains("rocks.lua:2: cdem.elastic: youngs_modulus: missing"));
}

TEST_CASE("errors of Lua itself keep their line", "[lua]") {
  CHECK_THAT(error_of("local x = nil\n\nprint(x.y)"), Contains("case.lua:3: attempt to index a nil value"));
  CHECK_THAT(error_of("for i = 1, 3 do\n"), Contains("case.lua:"));
  CHECK_THAT(error_of("for i = 1, 3 do\n"), Contains("'end' expected"));
  CHECK(error_of("error('enough')") == "case.lua:1: enough");
  CHECK_THAT(error_of("error({})"), Contains("case.lua:1: error value is a table"));
  CHECK_THAT(error_of("error(setmetatable({}, { __tostring = function() return 'mine' end }))"),
             Contains("mine"));
}

TEST_CASE("a first line for the shell and a byte order mark do not shift lines", "[lua]") {
  CHECK(error_of("#!/usr/bin/env cdem\nerror('x')") == "case.lua:2: x");
  CHECK(error_of("\xef\xbb\xbf"
                 "error('x')") == "case.lua:1: x");
}

TEST_CASE("calling in the wrong way is explained", "[lua]") {
  CHECK_THAT(error_of(errors_head + "cdem.elastic(30e9)"),
             Contains("takes a table with named values, not 3e+10"));
  CHECK_THAT(error_of(column() + "model:run{ duration = 1, mass_scaling = 100 }"),
             Contains("mass_scaling = 100: must be a table with named values; name the values: { "));
  CHECK_THAT(error_of(errors_head + "cdem.elastic({}, 2)"), Contains("takes one table"));
  CHECK_THAT(error_of(errors_head + "cdem.elastics{}"),
             Contains("case.lua:2: cdem.elastics: no such name; did you mean elastic?"));
  CHECK_THAT(error_of("local cdem = require 'cdem'\ncdem.sphere{ radius = 1 }"),
             Contains("case.lua:2: cdem.sphere: no such name; did you mean cdem.solid.sphere?"));
  CHECK_THAT(error_of(errors_head + "cdem.select.plain{}"), Contains("did you mean plane?"));
  CHECK_THAT(error_of(column() + "model.fix{ on = 'x-' }"),
             Contains("call it with a colon on a cdem.Model: model:fix(...)"));
  CHECK_THAT(error_of(column() + "model:fixx{ on = 'x-' }"),
             Contains("cdem.Model: fixx: no such name; did you mean fix?"));
  CHECK_THAT(error_of(column() + "print(rock.youngs)"), Contains("did you mean youngs_modulus?"));
  CHECK_THAT(error_of(column() + "model:max('displacement.x', 'x-', 3)"),
             Contains("3 arguments: takes (field, on)"));
  CHECK_THAT(error_of(column() + "model:energy(1)"), Contains("1 argument: takes none"));
  CHECK_THAT(error_of(errors_head + "local t = {}\nt.t = t\ncdem.report{ { name = 'a', value = t } }"),
             Contains("does it contain itself?"));
  CHECK_THAT(error_of(errors_head + "cdem.model{ bodies = { { shape = coroutine.create(print) } } }"),
             Contains("bodies[1].shape = a thread: must be a cdem.Assembly"));
}

TEST_CASE("errors of the mechanics carry the line of the call", "[lua]") {
  CHECK_THAT(error_of(column() + "model:max('displacment.x')"), Contains("case.lua:7: model:max: "));
  CHECK_THAT(error_of(column() + "model:max('displacment.x')"), Contains("displacement.x"));
  CHECK_THAT(
      error_of(column() + "model:fix{ on = cdem.select.plane{ point = {5, 0, 0}, normal = {1, 0, 0} } }"),
      Contains("case.lua:7: model:fix: "));
}

TEST_CASE("an unknown place names the nearest and lists those there are", "[lua]") {
  CHECK_THAT(error_of(column() + "model:fix{ on = 'q-' }"), Contains("on = \"q-\": no such place"));
  CHECK_THAT(error_of(column() + "model:fix{ on = 'colum' }"),
             Contains("did you mean column? There are: x-, x+, y-"));
  CHECK_THAT(error_of(column() + "model:fix{ on = {'x+', 'colum'} }"), Contains("on[2] = \"colum\""));
  CHECK_THAT(error_of(column() + "model:fix{ on = 3 }"), Contains("on = 3: must be a side"));
}

TEST_CASE("a script that is not there, or is a folder, is a file error", "[lua]") {
  Script script("");
  script.settings.script = script.folder / "missing.lua";
  CHECK_THROWS_AS(script.run(), FileError);
  script.settings.script = script.folder;
  CHECK_THROWS_AS(script.run(), FileError);
}

TEST_CASE("a missing data file stays a file error on its way through the script", "[lua]") {
  Script script(errors_head + "cdem.read_csv('missing.csv')");
  CHECK_THROWS_AS(script.run(), FileError);
  Script rethrown(errors_head + "local ok, e = pcall(cdem.read_csv, 'missing.csv')\nerror(e, 0)");
  CHECK_THROWS_AS(rethrown.run(), FileError);
}

TEST_CASE("a solution that runs away is a SolutionError, which a script may catch", "[lua]") {
  // A free block under a force has no balance: it is thrown out of the model.
  const std::string runaway = column() + "model:release{ on = 'x-' }\n"
                                         "model:initial_velocity{ velocity = {1e12, 0, 0} }\n";
  const std::string solve = "model:run{ steps = 100000 }\n";
  Script script(runaway + solve);
  CHECK_THROWS_AS(script.run(), cdem::SolutionError);
  CHECK(script.engine->model_saved_after_failure());
  CHECK(script.wrote("last_good.vtu"));
  Script caught(runaway + "local ok, e = pcall(function() " + solve + " end)\nprint(ok, e)");
  const std::string printed = caught.printed();
  CHECK(printed.rfind("false	", 0) == 0);
  CHECK_THAT(printed, Contains("case.lua:9: model:run: ") && Contains("run-away"));
  Script rethrown(runaway + "local ok, e = pcall(function() " + solve + " end)\nerror(e, 0)");
  CHECK_THROWS_AS(rethrown.run(), cdem::SolutionError);
}

TEST_CASE("a check tries the colours of joints and sections", "[lua]") {
  const auto checked = [](const std::string& picture) {
    Script script(column("{1, 1, 2}", "{1, 1, 2}") + "model:picture{ file = 'p.png', " + picture + " }");
    script.settings.check_only = true;
    return script.error();
  };
  CHECK(checked("joints = true, colour = 'slip'").empty());
  CHECK_THAT(checked("joints = true, colour = 'slipp'"), Contains("did you mean slip?"));
  const std::string section = "section = { point = {0.5, 0.5, 1}, normal = {0, 1, 0} }, colour = ";
  CHECK(checked(section + "'stress.zz'").empty());
  CHECK_THAT(checked(section + "'stress.zzz'"), Contains("did you mean stress.zz"));
  CHECK_THAT(checked("colour = 'slip'"), Contains("colour = \"slip\"") && Contains("add joints = true"));
}

TEST_CASE("waves enter a slope at its own level and depth, and weigh as the model does", "[lua][water]") {
  const auto slope = [](const std::string& waves, const std::string& more) {
    return errors_head + "local w = cdem.water." + waves +
           "\ncdem.water.slope{ bed = { {0, -4}, {10, -4}, {30, 6} }, " + "waves = w, duration = 2" + more +
           " }";
  };
  const std::string wave = "wave{ height = 0.2, period = 6, depth = 4, level = ";
  CHECK(error_of(slope(wave + "0 }", "")).empty());
  CHECK_THAT(
      error_of(slope(wave + "1 }", "")),
      Contains("case.lua:3: cdem.water.slope: waves = 4 m deep with still water at z = 1 m: must be") &&
          Contains("4 m and z = 0 m"));
  CHECK_THAT(error_of(slope("sea{ significant_height = 0.2, peak_period = 6, depth = 9 }", "")),
             Contains("waves = 9 m deep"));
  CHECK(error_of(slope(wave + "1 }", ", level = 1")) != ""); // 5 m deep then
  CHECK_THAT(error_of(slope(wave + "0, current = 0.5 }", "")), Contains("waves = on a current of 0.5 m/s"));
  CHECK_THAT(error_of(slope(wave + "0, direction = {-1, 0, 0} }", "")),
             Contains("waves = of direction {-1, 0, 0}: must be of the direction of the slope, {1, 0, 0}"));
  CHECK(error_of(slope(wave + "0, direction = {0, 2, 0} }", ", direction = {0, 1, 0}")).empty());
  const auto weighed = [](const std::string& water) {
    return error_of(column() + "model:gravity{ vector = {0, 0, -3.7} }\n" +
                    "model:flow{ water = cdem.water.uniform{ velocity = {0, 0, 0}, level = 1" + water +
                    " } }\nmodel:run{ steps = 2 }");
  };
  CHECK(weighed(", gravity = 3.7").empty());
  CHECK_THAT(weighed(""), Contains("gravity = {0, 0, -3.7}: must be (0, 0, -9.81) m/s2") &&
                              Contains("give the water the same `gravity`"));
  // A gravity that turns is refused at once, not when it has left the vertical.
  CHECK_THAT(
      error_of(
          column() +
          "model:gravity{ vector = function(t) return {9.81 * math.sin(t), 0, -9.81 * math.cos(t)} end }\n"
          "model:flow{ water = cdem.water.uniform{ velocity = {0, 0, 0}, level = 1 } }\n"
          "model:run{ steps = 2 }"),
      Contains("gravity = a function of time: must be the vector (0, 0, -9.81) m/s2"));
}
