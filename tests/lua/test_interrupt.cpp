#include "libcdem/step/errors.hpp"
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;

namespace {

// Runs text with a stop asked for after some looks.
void interrupt(const std::string& text) {
  Script script(text);
  int looks = 0;
  script.listener->stop = [&] { return ++looks > 3; };
  INFO(text);
  CHECK_THROWS_AS(script.run(), cdem::Interrupted);
  for (const std::string& line : script.listener->lines)
    CHECK(line != "swallowed");
}

} // namespace

TEST_CASE("an endless loop is interrupted", "[lua]") {
  interrupt("while true do end");
  interrupt("local function f() return f() end\nf()");
  interrupt("goto a\n::a::\ngoto a");
  interrupt("local t = setmetatable({}, { __index = function(t, k) return t[k + 1] and 0 end })\n"
            "while true do local x = pcall(function() return t[1] end) end");
}

TEST_CASE("a protected call cannot swallow an interrupt", "[lua]") {
  interrupt("pcall(function() while true do end end)\nprint 'swallowed'");
  interrupt("while true do pcall(function() while true do end end) end");
  interrupt("xpcall(function() while true do end end, print)\nprint 'swallowed'");
  interrupt("xpcall(function() while true do end end, function() while true do end end)\nprint 'swallowed'");
  interrupt(
      "local c = coroutine.create(function() while true do end end)\ncoroutine.resume(c)\nprint 'swallowed'");
  interrupt("local c = coroutine.wrap(function() while true do end end)\npcall(c)\nprint 'swallowed'");
  interrupt("pcall(pcall, pcall, pcall, function() while true do end end)\nprint 'swallowed'");
  interrupt("table.sort({1, 2, 3}, function() while true do end end)\nprint 'swallowed'");
  interrupt("pcall(string.gsub, 'aaa', 'a', function() while true do end end)\nprint 'swallowed'");
}

TEST_CASE("a solving call is interrupted, and a protected call around it does not hide that", "[lua]") {
  const std::string solve = "model:traction{ on = 'x+', stress = {1e6, 0, 0} }\nmodel:run{ duration = 1e9 }";
  interrupt(column() + solve);
  interrupt(column() + "pcall(function() " + solve + " end)\nprint 'swallowed'");
}

TEST_CASE("an endless callback is interrupted", "[lua]") {
  interrupt(column() + "model:traction{ on = 'x+', stress = {1e6, 0, 0},\n"
                       "  amplitude = function(t) if t > 0 then while true do end end return 1 end }\n"
                       "model:run{ duration = 1 }");
  interrupt(column() + "model:run{ duration = 1, every = 1, callback = function() while true do end end }");
  interrupt(column() + "model:fix{ on = function() while true do end end }");
}

TEST_CASE("after an interrupt the repl goes on", "[lua]") {
  Script script("");
  script.settings.script.clear();
  bool stop = true, incomplete = false;
  script.listener->stop = [&] { return stop; };
  Engine engine(script.settings);
  CHECK_THROWS_AS(engine.run_line("while true do end", incomplete), cdem::Interrupted);
  stop = false;
  CHECK(engine.run_line("1 + 1", incomplete) == "2");
}

TEST_CASE("protected calls otherwise work as in Lua", "[lua]") {
  CHECK(printed_by("print(pcall(error, 'a'))\nprint(pcall(function(...) return ... end, 1, nil, 3))\n"
                   "print(xpcall(function(a) return a + 1 end, print, 4))\n"
                   "print(xpcall(error, function(m) return 'handled ' .. m end, 'b'))\n"
                   "print(select('#', pcall(function() end)))") ==
        "false\ta\ntrue\t1\tnil\t3\ntrue\t5\nfalse\thandled b\n1");
  CHECK(
      printed_by(
          "local c = coroutine.create(function(a)\n"
          "  local ok, b = pcall(function() return coroutine.yield(a + 1) end)\n  return ok, b\nend)\n"
          "print(coroutine.resume(c, 1))\nprint(coroutine.resume(c, 'back'))\nprint(coroutine.resume(c))") ==
      "true\t2\ntrue\ttrue\tback\nfalse\tcannot resume dead coroutine");
}
