#include "libcdem/vtk/files.hpp"
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

TEST_CASE("save writes blocks, bonds beside them, and a series", "[lua]") {
  Script script(column() + "model:save{ file = 'a.vtu', series = 'all.pvd' }\nmodel:run{ steps = 3 }\n"
                           "model:save{ file = 'sub/b.vtu', series = 'all.pvd' }");
  script.run();
  CHECK(script.wrote("a.vtu"));
  CHECK(script.wrote("a_bonds.vtu"));
  CHECK(script.wrote("sub/b_bonds.vtu"));
  const std::string series = script.read("all.pvd");
  CHECK(series.find("a.vtu") < series.find("sub/b.vtu"));
  CHECK(series.find("sub/b.vtu") != std::string::npos);
  // One series each for what has other fields.
  CHECK_THAT(script.read("all_bonds.pvd"), Contains("a_bonds.vtu") && Contains("sub/b_bonds.vtu"));
}

TEST_CASE("save writes the contacts of bodies that move far, and their series", "[lua]") {
  Script script(
      "local cdem = require 'cdem'\n"
      "local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }\n"
      "local block = cdem.grid{ size = {1, 1, 1}, divisions = {1, 1, 1} }\n"
      "local model = cdem.model{ bodies = { { shape = block, material = rock, element = 'rigid' },\n"
      "  { shape = cdem.grid{ size = {1, 1, 1}, divisions = {1, 1, 1}, origin = {0, 0, 2} }, material = "
      "rock,\n"
      "    element = 'rigid' } },\n"
      "  contacts = { default = cdem.coulomb{ friction_angle = 30 } } }\n"
      "model:save{ file = 'a.vtu', series = 'all.pvd' }");
  CHECK(script.error() == "");
  CHECK(script.wrote("a_contacts.vtu"));
  CHECK_THAT(script.read("all_contacts.pvd"), Contains("a_contacts.vtu"));
}

TEST_CASE("save and pictures show the free surface of the water that loads a model", "[lua]") {
  Script script(column() +
                "local function draw(name, water, arrows)\n"
                "  model:picture{ file = name, view = 'top', up = 'z', size = {320, 240}, water = water,\n"
                "    water_velocity = arrows }\nend\n"
                "draw('dry.png')\n"
                "local box = cdem.water.uniform{ velocity = {1, 0, 0}, level = 100 }\n"
                "model:flow{ water = box }\n"
                "draw('wet.png') draw('without.png', false) draw('arrows.png', true, true)\n"
                "model:save{ file = 'a.vtu', series = 'all.pvd' }\n"
                "model:clear_loads()\n"
                "model:flow{ water = cdem.water.uniform{ velocity = {1, 0, 0} } }\n" // without a surface
                "draw('stream.png')\n"
                "model:save{ file = 'b.vtu' }");
  CHECK(script.error() == "");
  CHECK(script.read("dry.png") == script.read("without.png"));
  CHECK(script.read("dry.png") == script.read("stream.png"));
  CHECK(script.read("dry.png") != script.read("wet.png"));
  CHECK(script.read("arrows.png") != script.read("wet.png"));
  CHECK(script.wrote("a_water.vtu"));
  CHECK_THAT(script.read("all_water.pvd"), Contains("a_water.vtu"));
  CHECK(!script.wrote("b_water.vtu"));
}

TEST_CASE("a picture has z up where gravity acts along z, unless the script says otherwise", "[lua]") {
  Script script(column() + "local function draw(name, up)\n"
                           "  model:picture{ file = name, up = up, size = {320, 240} }\nend\n"
                           "model:gravity{ vector = {0, -9.81, 0} }\ndraw('first.png')\ndraw('y.png', 'y')\n"
                           "model:gravity{ vector = {0, 0, -9.81} }\ndraw('second.png')\ndraw('z.png', 'z')");
  CHECK(script.error() == "");
  CHECK(script.read("first.png") == script.read("y.png"));
  CHECK(script.read("second.png") == script.read("z.png"));
  CHECK(script.read("y.png") != script.read("z.png"));
}

TEST_CASE("a chart over time marks its stages, unless they are one or many", "[lua]") {
  const auto drawn = [](const std::string& runs, const std::string& options) {
    Script script(column() + "model:initial_velocity{ velocity = {1, 0, 0} }\n" + runs +
                  "model:chart{ file = 'c.png', y = {'kinetic_energy'}, x = 'time', size = {320, 240}" +
                  options + " }");
    script.run();
    return script.read("c.png");
  };
  const std::string run = "model:run{ steps = 20 }\n";
  CHECK(drawn(run + run, "") == drawn(run + run, ", stages = true"));
  CHECK(drawn(run + run, "") != drawn(run + run, ", stages = false"));
  CHECK(drawn(run, "") == drawn(run, ", stages = false"));
  CHECK(drawn(run, "") != drawn(run, ", stages = true"));
  const std::string many = "for _ = 1, 9 do " + run + "end\n";
  CHECK(drawn(many, "") == drawn(many, ", stages = false"));
  // Over steps, which relaxations take too, where it is asked for.
  const auto over_steps = [](const std::string& options) {
    Script script(
        column() +
        "model:traction{ on = 'x+', stress = {1e5, 0, 0} }\nmodel:relax{}\nmodel:relax{ residual = 1e-6 }\n"
        "model:chart{ file = 'c.png', y = {'residual'}, size = {320, 240}" +
        options + " }");
    script.run();
    return script.read("c.png");
  };
  CHECK(over_steps("") == over_steps(", stages = false"));
  CHECK(over_steps("") != over_steps(", stages = true"));
  CHECK_THAT(Script(column() + run +
                    "model:chart{ file = 'c.png', x = 'residual', y = {'kinetic_energy'}, stages = true }")
                 .error(),
             Contains("stages: are marked over time and steps; give x = \"time\""));
}

TEST_CASE("pictures and charts are written as PNG, SVG and PDF", "[lua]") {
  Script script(
      column() +
      "model:run{ steps = 20 }\n"
      "model:picture{ file = 'p.png', colour = 'displacement.x', size = {320, 240},\n"
      "  markers = { { at = {0, 0, 0}, label = 'here' } }, lines = { { points = { {0,0,0}, {1,0,0} } } } }\n"
      "model:chart{ file = 'h.png', y = {'kinetic_energy'}, x = 'time', size = {320, 240} }\n"
      "cdem.chart{ file = 'c.png', size = {320, 240}, series = { { name = 'a', x = {1, 2, 3}, y = {1, 0/0, "
      "9} } } }");
  script.run();
  for (const std::string name : {"p.png", "h.png", "c.png"})
    CHECK(script.read(name).rfind("\x89PNG", 0) == 0);
  Script vector(
      column() +
      "model:picture{ file = 'p.svg', size = {320, 240}, dpi = 100 }\n"
      "cdem.chart{ file = 'c.pdf', size = {320, 240}, series = { { name = 'a', x = {1, 2}, y = {1, 2} } } }");
  CHECK(vector.error() == "");
  CHECK_THAT(vector.read("p.svg"), Contains("<svg") && Contains("width=\"81.28mm\""));
  CHECK(vector.read("c.pdf").rfind("%PDF", 0) == 0);
}

TEST_CASE("an unknown colour is named as the script calls it, by a check and by a run", "[lua]") {
  const auto refused = [](const std::string& colour, bool check_only) {
    Script script(column() + "model:picture{ file = 'p.png', size = {320, 240}, colour = '" + colour + "' }");
    script.settings.check_only = check_only;
    return script.error();
  };
  for (const bool check_only : {false, true}) {
    CHECK_THAT(refused("displacment.z", check_only),
               Contains("case.lua:7: model:picture: colour = \"displacment.z\": must be ") &&
                   Contains("did you mean displacement.z"));
    CHECK_THAT(refused("contact_force", check_only),
               Contains("case.lua:7: model:picture: colour = \"contact_force\": must be "));
    CHECK(refused("displacement", check_only) == ""); // its magnitude
  }
}

TEST_CASE("columns of numbers survive writing and reading", "[lua]") {
  Script script(
      "local cdem = require 'cdem'\n"
      "cdem.write_csv{ file = 't.csv', columns = { { name = 'x', values = {0.1, 1e-300, -5} }, { name = 'y', "
      "values = {1, 0/0, 3} } } }\n"
      "local t = cdem.read_csv('t.csv')\nassert(t.x[1] == 0.1 and t.x[2] == 1e-300 and t.x[3] == -5)\n"
      "assert(t.y[1] == 1 and t.y[2] ~= t.y[2] and t.y[3] == 3)");
  CHECK(script.error() == "");
  CHECK(script.read("t.csv") == "x,y\n0.1,1\n1e-300,\n-5,3\n");
}

TEST_CASE("names with commas, quotes and blanks survive in a table", "[lua]") {
  Script script("local cdem = require 'cdem'\n"
                "cdem.write_csv{ file = 't.csv', columns = { { name = 'force, N', values = {1} },\n"
                "  { name = 'the \"old\" one', values = {2} }, { name = 'plain', values = {3} } } }\n"
                "local t = cdem.read_csv('t.csv')\n"
                "assert(t['force, N'][1] == 1 and t['the \"old\" one'][1] == 2 and t.plain[1] == 3)");
  CHECK(script.error() == "");
  CHECK(script.read("t.csv") == "\"force, N\",\"the \"\"old\"\" one\",plain\n1,2,3\n");
  Script foreign("local t = require('cdem').read_csv('t.csv')\nassert(t.a[1] == 1 and t['b c'][1] == 2)");
  foreign.write("t.csv", "a , \"b c\"\r\n 1,\"2\"\r\n"); // as a spreadsheet writes it
  CHECK(foreign.error() == "");
}

TEST_CASE("tables that do not fit are refused with their row", "[lua]") {
  const auto error_for = [](const std::string& text) {
    Script script("require('cdem').read_csv('t.csv')");
    script.write("t.csv", text);
    return script.error();
  };
  CHECK_THAT(error_for("a,b\n1,2\n3\n"), Contains("line 3 has 1 value: must be 2"));
  CHECK_THAT(error_for("a,b\n1,two\n"), Contains("line 2, column \"b\": \"two\": must be a number"));
  CHECK_THAT(error_for(""), Contains("is empty"));
}

TEST_CASE("a table without names of columns is refused, as is one with a name twice", "[lua]") {
  const auto error_for = [](const std::string& text) {
    Script script("require('cdem').read_csv('t.csv')");
    script.write("t.csv", text);
    return script.error();
  };
  CHECK_THAT(error_for("1,2\n3,4\n"), Contains("first row holds numbers"));
  CHECK_THAT(error_for("a,a\n3,4\n"), Contains("two columns are named \"a\""));
}

TEST_CASE("numbers at equal distances include both ends", "[lua]") {
  CHECK(
      error_of(
          "local l = require('cdem').linspace(0.1, 0.7, 4)\nassert(#l == 4 and l[1] == 0.1 and l[4] == 0.7)\n"
          "assert(math.abs(l[2] - 0.3) < 1e-15)") == "");
}

TEST_CASE("print, io.write and cdem.log go to the log, line by line", "[lua]") {
  CHECK(
      printed_by(
          "print(1, 'a', nil, true)\nio.write('b', 2, '\\nc')\nio.write('d\\n')\nrequire('cdem').log('e')") ==
      "1\ta\tnil\ttrue\nb2\ncd\ne");
}
