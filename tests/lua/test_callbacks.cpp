#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

TEST_CASE("a callback is called every so many steps", "[lua]") {
  CHECK(printed_by(column() + "local n = 0\nmodel:run{ steps = 50, every = 10, callback = function() n = n + "
                              "1 end }\nprint(n)") == "5");
}

TEST_CASE("stop ends a run", "[lua]") {
  CHECK(printed_by(
            column() +
            "local n = 0\nlocal r = model:run{ every = 10, stop = function() n = n + 1 return n == 3 end }\n"
            "print(r.steps)") == "30");
}

TEST_CASE("an error in a callback names its own line and ends the stage", "[lua]") {
  CHECK_THAT(
      error_of(column() +
               "model:run{ steps = 50, every = 10,\n  callback = function()\n    local x = nil + 1\n  end }"),
      Contains("case.lua:9: attempt to perform arithmetic on a nil value"));
  CHECK(printed_by(column() + "print(pcall(function() model:run{ steps = 50, every = 10, callback = "
                              "function() error('x', 0) end } end))\n"
                              "model:run{ steps = 1 }") == "false\tx");
}

TEST_CASE("a callback may read the model and may not change it", "[lua]") {
  const std::string front = column() + "model:run{ steps = 10, every = 10, callback = function() ";
  CHECK(error_of(front + "local a, b, c = model.time, model:counts(), model:max('velocity.x') end }") == "");
  for (const std::string call :
       {"model:run{ steps = 1 }", "model:relax{}", "model:refine{}", "model:fix{ on = 'x+' }",
        "model:gravity{ vector = {0, 0, -9.81} }", "model:remove{ on = 'all' }"})
    CHECK_THAT(error_of(front + call + " end }"), Contains("not from a callback of a running stage"));
}

TEST_CASE("an amplitude must give a finite number, and is asked at once", "[lua]") {
  const std::string front = column() + "model:traction{ on = 'x+', stress = {1, 0, 0}, amplitude = ";
  CHECK_THAT(error_of(front + "function(t) return 0 / 0 end }"),
             Contains("case.lua:7: model:traction: amplitude(0)"));
  CHECK_THAT(error_of(front + "function(t) end }"), Contains("= nothing: must be a finite number"));
  CHECK_THAT(error_of(front + "2 }"), Contains("amplitude = 2: must be a function"));
}

TEST_CASE("an error inside a function of the script tells the call", "[lua]") {
  const auto error = [](const std::string& call) { return error_of(column() + call); };
  CHECK_THAT(error("model:traction{ on = 'x+', stress = {1, 0, 0}, amplitude = function(t)\n"
                   "  if t > 0 then return t + missing end\n  return 1\nend }\nmodel:run{ duration = 0.01 }"),
             Contains("case.lua:8: attempt to perform arithmetic on a nil value (global 'missing'), in "
                      "amplitude(") &&
                 Contains(") of case.lua:7") && !Contains("amplitude(0)"));
  CHECK_THAT(error("model:gravity{ vector = function(t) return {0, 0, -missing} end }"),
             Contains("(global 'missing'), in vector(0) of case.lua:7"));
  CHECK_THAT(error("model:traction{ on = 'x+', pressure = function(x, y, z) return x.y end }\n"
                   "model:run{ steps = 1 }"),
             Contains("attempt to index a number value (local 'x'), in pressure(2, ") &&
                 Contains(") of case.lua:7"));
  CHECK_THAT(error("cdem.water.field{ velocity = function(x, y, z, t) error('dry', 0) end }"),
             Contains("dry, in velocity(0, 0, 0, 0) of case.lua:7"));
  CHECK_THAT(error("model:fix{ on = function(x, y, z) return missing > 0 end }"),
             Contains("in function(") && Contains(") of case.lua:7"));
}

TEST_CASE("a predicate must say true or false", "[lua]") {
  CHECK_THAT(error_of(column() + "model:fix{ on = function(x, y, z) return x end }"),
             Contains("must be true or false"));
  CHECK_THAT(error_of(column() + "model:fix{ on = cdem.select.where(3) }"),
             Contains("predicate = 3: must be a function"));
}

TEST_CASE("callbacks work inside coroutines", "[lua]") {
  CHECK(printed_by(
            column() +
            "local c = coroutine.wrap(function()\n"
            "  model:fix{ on = function(x, y, z) return x > 1.9 end, axes = 'y' }\n  coroutine.yield(1)\n"
            "  local n = 0\n  model:run{ steps = 20, every = 10, callback = function() n = n + 1 end }\n"
            "  coroutine.yield(n)\nend)\nprint(c(), c())") == "1\t2");
}

TEST_CASE("model.memory holds plain values only", "[lua]") {
  CHECK(printed_by(column() + "model.memory.count = 0\nmodel.memory.list = { 1, 2, { a = 'b' } }\n"
                              "model:run{ steps = 20, every = 10, callback = function() model.memory.count = "
                              "model.memory.count + 1 end }\n"
                              "print(model.memory.count, model.memory.list[3].a)") == "2\tb");
  CHECK(printed_by(column() + "model.memory = { a = 1 }\nprint(model.memory.a)") == "1");
  // In the line that assigns them.
  CHECK_THAT(error_of(column() + "model.memory.f = print\n"),
             Contains("case.lua:7: ") && Contains("model.memory.f = function: must be a plain value"));
  CHECK_THAT(error_of(column() + "model.memory = { a = 1 }\nmodel.memory.m = { model }\n"),
             Contains("case.lua:8: ") && Contains("model.memory.m[1] = cdem.Model"));
  // What goes round that door when the next stage begins.
  const std::string run = "\nmodel:run{ steps = 1 }";
  CHECK_THAT(error_of(column() + "model.memory.f = 1\nmodel.memory.f = print" + run),
             Contains("model.memory.f = function: must be a plain value"));
  CHECK_THAT(error_of(column() + "model.memory.t = model.memory" + run), Contains("does it contain itself?"));
  CHECK_THAT(error_of(column() + "model.memory[2.5] = 1" + run), Contains("key 2.5"));
  CHECK_THAT(error_of(column() + "model.memory = 3"), Contains("memory = 3: must be a table"));
}

TEST_CASE("a function is called after every stage", "[lua]") {
  CHECK(printed_by(
            column() +
            "model:after_stage(function(stage) print(stage.number, stage.kind, stage.result.steps) end)\n"
            "model:run{ steps = 7 }\nmodel:run{ steps = 8 }") == "1\trun\t7\n2\trun\t8");
  CHECK_THAT(
      error_of(column() + "model:after_stage(function() model:run{ steps = 1 } end)\nmodel:run{ steps = 1 }"),
      Contains("not from a callback of a running stage"));
}

TEST_CASE("a check calls every callback once, and finds wrong keys in it", "[lua]") {
  const auto checked = [](const std::string& text) {
    Script script(text);
    script.settings.check_only = true;
    return script.error();
  };
  const std::string jointed = column();
  for (const std::string wrong :
       {"model:picture{ file = 'a.png', color = 'stress.xx' }", "model:save{ fil = 'a.vtu' }",
        "cdem.film{ file = 'a.ogv', frame = {} }", "cdem.report{ { name = 'a', valu = 1 } }",
        "cdem.write_csv{ file = 'a.csv', column = {} }"})
    for (const std::string call :
         {"model:relax{ callback = ", "model:run{ steps = 9, callback = ", "model:run{ stop = ",
          "model:grow{ callback = ", "model:settle{ callback = "}) {
      INFO(call << wrong);
      CHECK_THAT(checked(jointed + call + "function() if model.time == 0 then\n" + wrong + " end end }"),
                 Contains("case.lua:8: ") && Contains("no such key; did you mean"));
    }
  CHECK_THAT(
      checked(jointed + "model:after_stage(function() model:save{ fil = 'a.vtu' } end)\nmodel:relax{}"),
      Contains("case.lua:7: ") && Contains("no such key"));
  CHECK_THAT(checked(jointed + "model:run{ steps = 1, callback = function() model:relax{} end }"),
             Contains("not from a callback of a running stage"));
  CHECK(checked(jointed +
                "local calls = 0\n"
                "model:grow{ callback = function(pass) calls = calls + 1 + #pass.faces + #pass.path end }\n"
                "assert(calls == 1)") == "");
}

TEST_CASE("a check writes no file, and judges where a script would", "[lua]") {
  Script script("local file = io.open('lines.txt', 'w')\nfile:write('one')\nfile:close()\n"
                "io.open('more/lines.txt', 'a'):write('two')");
  script.settings.check_only = true;
  CHECK(script.error() == "");
  CHECK_FALSE(script.wrote("lines.txt"));
  CHECK_FALSE(script.wrote("more"));
  Script outside("io.open('../lines.txt', 'w')");
  outside.settings.check_only = true;
  CHECK_THAT(outside.error(), Contains("inside the output folder"));
}
