// A model through the whole binding: against formulas where there are some.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

const std::string pulled = column() + "model:traction{ on = 'x+', stress = {1e6, 0, 0} }\n";

} // namespace

// Two blocks of 1 m with nu = 0 and a joint of stiffness E/L, L = 0.02 x 1 m, in series:
// u = sigma/E (1 + 1) + sigma L/E = 1e-3 x 2.02 m.
TEST_CASE("a bar of two blocks is as long as its blocks and its joint in series", "[lua]") {
  CHECK(error_of(pulled + "local r = model:relax{ residual = 1e-9, breaking = false }\nassert(r.converged)\n"
                          "local function close(a, b, what) assert(math.abs(a - b) <= 1e-6 * math.abs(b), "
                          "what .. ' ' .. a) end\n"
                          "close(model:max('displacement.x'), 2.02e-3, 'max')\n"
                          "close(model:mean('displacement.x', 'x+'), 2.02e-3, 'mean')\n"
                          "close(model:at('displacement.x', {0.5, 0.5, 0.5}), 0.5e-3, 'at')\n"
                          "close(model:mean('stress.xx'), 1e6, 'stress')\n"
                          "close(model:max{ field = 'stress.xx', on = 'column' }, 1e6, 'named')\n"
                          "close(model:reaction('x-')[1], -1e6, 'reaction')\n"
                          "close(model:find_max('displacement.x').place[1], 2, 'place')\n"
                          "close(model:energy().elastic, 1e6 * 1e-3 / 2 * 2, 'elastic')\n"
                          "close(model:energy().springs, 1e6 * 0.02e-3 / 2, 'springs')\n"
                          "assert(r.steps == model.steps and model.residual <= 1e-9)\n"
                          "local b = model:blocks()\nassert(#b == 2 and b[1].body == 'column')\n"
                          "close(b[2].displacement[1], 1.52e-3, 'block')") == "");
}

TEST_CASE("an amplitude scales its load", "[lua]") {
  CHECK(error_of(column() +
                 "model:traction{ on = 'x+', stress = {1e6, 0, 0}, amplitude = function() return 0.5 end }\n"
                 "model:relax{ residual = 1e-9, breaking = false }\n"
                 "assert(math.abs(model:max('displacement.x') - 1.01e-3) < 1e-9)") == "");
}

TEST_CASE("places by side, plane, box, predicate, name and list select the same face", "[lua]") {
  const std::string place =
      GENERATE(as<std::string>{}, "'x+'", "cdem.select.plane{ point = {2, 0, 0}, normal = {1, 0, 0} }",
               "cdem.select.box{ min = {1.9, 0, 0}, max = {2, 1, 1} }",
               "cdem.select.where(function(x) return x > 1.99 end)", "function(x) return x > 1.99 end",
               "'tip'", "{'tip'}");
  INFO(place);
  CHECK(error_of(column() +
                 "model:select{ name = 'tip', on = 'x+' }\nmodel:force{ on = 'x+', force = {0, 0, 0} }\n"
                 "model:fix{ on = " +
                 place +
                 ", axes = 'x', displacement = {2.02e-3, 0, 0} }\n"
                 "model:relax{ residual = 1e-8, breaking = false }\n"
                 "assert(math.abs(model:reaction('x+')[1] / 1e6 - 1) < 1e-6, model:reaction('x+')[1])") ==
        "");
}

TEST_CASE("counts are those of the assembly", "[lua]") {
  // A box has 6 faces of 4 edges: 24 tets, 8 + 6 + 1 nodes. A matching face has 5 springs (4 corners and the
  // centre).
  CHECK(error_of(column() +
                 "local c = model:counts()\nassert(c.bodies == 1 and c.blocks == 2 and c.tets == 48)\n"
                 "assert(c.nodes == 30 and c.interfaces == 1 and c.bonds == 5 and c.intact == 5)") == "");
}

TEST_CASE("the tables that calls return have the fields they declare", "[lua]") {
  Script script(pulled + "local r = model:relax{ breaking = false }\n"
                         "print(cdem.describe{ r, model:energy(), model:counts(), model:blocks()[1], "
                         "model:box(), model:stages()[1] })");
  const std::string all = script.printed();
  for (const std::string name :
       {"converged", "residual", "broken_tension", "wall_time", "balance_error", "external_peak",
        "interfaces", "contacts", "centroid", "generation", "hash", "kind", "number"})
    CHECK_THAT(all, Contains(name + " = "));
}

TEST_CASE("stages are numbered over all models and hashed by their arguments", "[lua]") {
  CHECK(
      error_of(
          pulled +
          "model:relax{ breaking = false }\nmodel:relax{ breaking = false }\nmodel:relax{ breaking = false, "
          "residual = 1e-7 }\n"
          "local other = cdem.model{ bodies = { { shape = cdem.box{ size = {1,1,1} }, material = rock } } }\n"
          "other:run{ steps = 1 }\n"
          "local s, o = model:stages(), other:stages()\nassert(#s == 3 and #o == 1)\n"
          "assert(s[1].number == 1 and s[3].number == 3 and o[1].number == 4 and o[1].kind == 'run')\n"
          "assert(s[1].hash == s[2].hash and s[2].hash ~= s[3].hash)\nassert(s[1].result.converged)") == "");
}

TEST_CASE("a broken bond is told with its mode and place", "[lua]") {
  CHECK(error_of(
            column() +
            "local weak = cdem.mohr_coulomb{ cohesion = 1e9, friction_angle = 30, tensile_strength = 5e5 }\n"
            "model = cdem.model{ bodies = { { shape = cdem.grid{ size = {2,1,1}, divisions = {2,1,1} }, "
            "material = rock, joint = weak } } }\n"
            "model:fix{ on = {'x-', 'x+'}, axes = 'xyz' }\nmodel:fix{ on = 'x+', axes = 'x', displacement = "
            "{2e-3, 0, 0} }\n"
            "local r = model:relax{ residual = 1e-6 }\nassert(r.broken_tension == 5 and r.broken_shear == 0, "
            "cdem.describe(r))\n"
            "local b = model:breaks()\nassert(#b == 5)\nfor _, row in ipairs(b) do\n"
            "  assert(row.mode == 'tension' and math.abs(row.place[1] - 1) < 1e-9 and row.normal_traction >= "
            "5e5)\nend") == "");
}

TEST_CASE("a notch is unbonded and an excavation removed, and told how many", "[lua]") {
  CHECK(error_of(column("{3, 1, 1}", "{3, 1, 1}") +
                 "assert(model:break_bonds{ on = cdem.select.plane{ point = {1, 0, 0}, normal = {1, 0, 0} } "
                 "} == 5)\n"
                 "assert(model:counts().intact == 5)\n"
                 "assert(model:remove{ on = cdem.select.box{ min = {2, 0, 0}, max = {3, 1, 1} } } == 1)\n"
                 "assert(model:counts().blocks == 2)") == "");
}

TEST_CASE("histories and probes come as lists of one length and as history.csv", "[lua]") {
  Script script(pulled + "model:probe{ name = 'ux', field = 'displacement.x', at = {2, 0.5, 0.5} }\n"
                         "model:relax{ residual = 1e-9, breaking = false }\nlocal h = model:history()\n"
                         "for name, list in pairs(h) do assert(#list == #h.step, name) end\n"
                         "assert(math.abs(h.ux[#h.ux] - 2.02e-3) < 1e-8, h.ux[#h.ux])\n"
                         "assert(#cdem.read_csv('history.csv').ux == #h.ux)");
  CHECK(script.error() == "");
  CHECK(script.read("history.csv")
            .rfind("stage,step,time,residual,kinetic_energy,external_work,broken_tension,broken_shear,ux\n",
                   0) == 0);
}

TEST_CASE("history.csv has every row once, also where stages follow each other and a probe comes later",
          "[lua]") {
  Script script(pulled + "local function same()\n"
                         "  local file, h = cdem.read_csv('history.csv'), model:history()\n"
                         "  for name, list in pairs(h) do\n"
                         "    assert(#file[name] == #list, name)\n"
                         "    for i, x in ipairs(list) do assert(file[name][i] == x or x ~= x, name) end\n"
                         "  end\n"
                         "end\n"
                         "for i = 1, 3 do model:run{ steps = 15 } same() end\n"
                         "model:probe{ name = 'ux', field = 'displacement.x', at = {2, 0.5, 0.5} }\n"
                         "for i = 1, 2 do model:run{ steps = 15 } same() end");
  CHECK(script.error() == "");
}

namespace {

// hash(contacts): the state of three blocks in a row after they were pushed along it and across.
std::string row_of_blocks(const std::string& script) {
  return column() +
         "local function block(x)\n"
         "  return { shape = cdem.grid{ size = {1, 1, 1}, divisions = {1, 1, 1}, origin = {x, 0, 0} },\n"
         "           material = rock, joint = joint, name = 'block' .. x }\nend\n"
         "local smooth, rough = cdem.coulomb{ friction_angle = 10 }, cdem.coulomb{ friction_angle = 40 }\n"
         "local function hash(contacts)\n"
         "  local row = cdem.model{ bodies = { block(0), block(1), block(2) }, contacts = contacts }\n"
         "  assert(row:counts().interfaces == 2)\n"
         "  row:fix{ on = 'x-', axes = 'xyz' }\n"
         "  row:traction{ on = 'x+', stress = {-1e6, 6e5, 0} }\n"
         "  row:run{ steps = 200 }\n"
         "  return row.state_hash\nend\n" +
         script;
}

} // namespace

TEST_CASE("default is the law of the pairs that are not named", "[lua]") {
  CHECK(
      error_of(row_of_blocks(
          "local named = hash{ { 'block0', 'block1', rough }, { 'block1', 'block2', rough } }\n"
          "assert(hash{ default = rough } == named)\n"
          "assert(hash{ default = smooth } ~= named)\n"
          "assert(hash{ default = smooth, { 'block1', 'block0', rough }, { 'block1', 'block2', rough } } == "
          "named)\n"
          "assert(hash{ default = rough, { 'block1', 'block2', smooth } } ==\n"
          "       hash{ { 'block0', 'block1', rough }, { 'block1', 'block2', smooth } })")) == "");
  CHECK_THAT(error_of(row_of_blocks("hash{ { 'block0', 'block1', rough } }")),
             Contains("\"block1\" and \"block2\" touch but no joint between them is given") &&
                 Contains("or default = joint"));
  CHECK_THAT(error_of(row_of_blocks("hash{ defualt = rough }")),
             Contains("contacts: defualt: no such key; did you mean default?"));
  CHECK_THAT(error_of(row_of_blocks("hash{ default = rock }")),
             Contains("contacts.default = cdem.Material: must be a cdem.Joint"));
}

TEST_CASE("bodies and contacts that do not fit are refused", "[lua]") {
  const std::string box = "local a = cdem.grid{ size = {1,1,1}, divisions = {2,1,1} }\n";
  CHECK_THAT(error_of(column() + box + "cdem.model{ bodies = { { shape = a, material = rock } } }"),
             Contains("bodies[1].joint: missing; the body has 2 blocks"));
  CHECK_THAT(error_of(column() + box +
                      "cdem.model{ bodies = { { shape = a, material = rock, joint = joint, name = 'a' }, { "
                      "shape = a, material = rock, joint = joint, name = 'a' } } }"),
             Contains("bodies[2].name = \"a\": must be unique"));
  CHECK_THAT(error_of(column() + box +
                      "cdem.model{ bodies = { { shape = a, material = rock, joint = joint, name = 'left' } "
                      "}, contacts = { { 'left', 'rihgt', joint } } }"),
             Contains("contacts[1]: no body \"rihgt\""));
  CHECK_THAT(
      error_of(column() + box + "cdem.model{ bodies = { { shape = a, material = joint, joint = joint } } }"),
      Contains("bodies[1].material = cdem.Joint: must be a cdem.Material"));
  CHECK_THAT(
      error_of(column() + box +
               "cdem.model{ bodies = { { shape = a, material = rock, joint = joint, element = 'rigd' } } }"),
      Contains("element = \"rigd\": must be one of \"small_strain\", \"finite_volume\""));
  CHECK_THAT(error_of(column() + "cdem.model{ bodies = {} }"),
             Contains("bodies = {}: must be a list of at least 1 item"));
}

TEST_CASE("a body whose cuts would fall apart is not refined", "[lua]") {
  CHECK_THAT(error_of(column() + "local one = cdem.model{ bodies = { { shape = cdem.box{ size = {1,1,1} }, "
                                 "material = rock, name = 'one' } } }\none:refine{}"),
             Contains("body \"one\" has no joint"));
}

TEST_CASE("a body without a joint is no hindrance where none of its blocks may be cut", "[lua]") {
  const std::string pair =
      column() + "local function two(element) return cdem.model{ bodies = { "
                 "{ shape = cdem.box{ size = {1,1,1} }, material = rock, joint = joint, name = 'a' }, "
                 "{ shape = cdem.box{ size = {1,1,1}, origin = {5,0,0} }, material = rock, name = 'b', "
                 "element = element } } } end\n";
  CHECK_THAT(error_of(pair + "two():refine{}"), Contains("body \"b\" has no joint"));
  Script script(pair + "two('rigid'):refine{}\ntwo():refine{ region = 'a' }");
  script.run();
}

TEST_CASE("a check names stages of one kind in a row in one line", "[lua]") {
  Script script(column() +
                "for _ = 1, 3 do model:run{ steps = 2 } end\nmodel:relax{}\nmodel:run{ steps = 2 }\n");
  script.settings.check_only = true;
  CHECK(script.error() == "");
  CHECK_THAT(script.engine->model_summary(),
             Contains("  stages 1-3: run\n  stage 4: relax\n  stage 5: run\n"));
}

TEST_CASE("a check builds the model and returns typed, empty results", "[lua]") {
  Script script(pulled +
                "local r = model:relax{}\nassert(r.converged == false and r.steps == 0 and r.residual == 0)\n"
                "assert(#model:refine{} == 0)\nassert(#model:grow{}.passes == 0)\n"
                "assert(model:run{ steps = 5 }.time == 0)\nassert(#model:stages() == 4)\n"
                "model:picture{ file = 'a.png', colour = 'displacement.x' }\nmodel:save{ file = 'a.vtu' }\n"
                "model:chart{ file = 'c.png', y = {'residual'} }\n"
                "cdem.report{ { name = 'a', value = model:max('displacement.x') / 0 } }");
  script.settings.check_only = true;
  CHECK(script.error() == "");
  CHECK(fs::is_empty(script.settings.output));
  CHECK_THAT(script.engine->model_summary(), Contains("1 body (column), 2 blocks, 48 tets"));
  CHECK_THAT(script.engine->model_summary(),
             Contains("traction {1000000, 0, 0} Pa on x+") || Contains("traction {1e+06, 0, 0} Pa on x+"));
  CHECK_THAT(script.engine->model_summary(), Contains("stage 1: relax"));
}

TEST_CASE("a check finds what would fail after hours", "[lua]") {
  const auto check_error = [](const std::string& text) {
    Script script(pulled + "model:relax{}\n" + text);
    script.settings.check_only = true;
    return script.error();
  };
  CHECK_THAT(check_error("model:picture{ file = 'a.png', colour = 'displacment.x' }"),
             Contains("did you mean displacement.x"));
  CHECK_THAT(check_error("model:picture{ file = 'a.jpg' }"), Contains("a name that ends in .png"));
  CHECK_THAT(check_error("model:save{ file = 'a.vtk' }"), Contains("a name that ends in .vtu"));
  CHECK_THAT(check_error("model:chart{ file = 'a.png', y = {'residuals'} }"),
             Contains("did you mean residual?"));
  CHECK_THAT(check_error("cdem.report{ { name = 1 } }"), Contains("name = 1: must be a string"));
}

TEST_CASE("the repl prints values, waits for more lines and completes names", "[lua]") {
  Script script("");
  script.settings.script.clear();
  Engine engine(script.settings);
  bool incomplete = false;
  CHECK(engine.run_line("1 + 1, 'a', { x = { 1, 2 } }", incomplete) == "2\ta\t{x = {1, 2}}");
  CHECK(engine.run_line("x = cdem.box{ size = {1, 1, 1} }", incomplete).empty());
  CHECK(engine.run_line("x", incomplete) == "cdem.Assembly (1 block)");
  CHECK(engine.run_line("for i = 1, 2 do", incomplete).empty());
  CHECK(incomplete);
  CHECK_THROWS_AS(engine.run_line("1 +* 2", incomplete), ScriptError);
  CHECK_FALSE(incomplete);
  const auto has = [](const std::vector<std::string>& all, const std::string& name) {
    return std::find(all.begin(), all.end(), name) != all.end();
  };
  CHECK(engine.complete("cdem.gr") == std::vector<std::string>{"cdem.grid"});
  CHECK(engine.complete("cdem.select.p") == std::vector<std::string>{"cdem.select.plane"});
  CHECK(engine.complete("x:vo") == std::vector<std::string>{"x:volume"});
  CHECK(has(engine.complete("cd"), "cdem"));
  CHECK(has(engine.complete("string.f"), "string.format"));
  CHECK(engine.complete("nothing.at.all").empty());
}

TEST_CASE("a check tells of models that the script has let go of", "[lua]") {
  Script script(
      column() +
      "model = nil\ncollectgarbage()\n"
      "model = cdem.model{ bodies = { { shape = cdem.box{ size = {1, 1, 1} }, material = rock } } }");
  script.settings.check_only = true;
  script.run();
  CHECK_THAT(script.engine->model_summary(), Contains("model 1: 1 body (column), 2 blocks") &&
                                                 Contains("model 2: 1 body (body_1), 1 block, 24 tets"));
}
