// What a script may not do, tried.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

TEST_CASE("commands, foreign code and introspection are refused with the remedy", "[lua]") {
  const std::string call = GENERATE(
      as<std::string>{}, "os.execute('true')", "os.exit(0)", "os.getenv('HOME')", "os.remove('case.lua')",
      "os.rename('case.lua', 'b.lua')", "os.tmpname()", "os.setlocale('C')", "io.popen('true')",
      "io.tmpfile()", "io.input('case.lua')", "io.output('x')", "io.read()", "dofile('case.lua')",
      "loadfile('case.lua')", "package.loadlib('libc.so.6', 'system')", "package.searchpath('x', '?.so')",
      "debug.sethook()", "debug.getregistry()", "debug.getinfo(1)", "debug.getupvalue(print, 1)",
      "debug.setmetatable(1, {})", "setmetatable({}, { __gc = print })", "string.dump(function() end)",
      "('x').dump(function() end)");
  const std::string error = error_of("local x = " + call);
  INFO(call);
  CHECK_THAT(error, Contains("case.lua:1: "));
  CHECK_THAT(error, Contains("not available to scripts; run with --unsafe to allow it"));
}

TEST_CASE("bytecode is not loaded, whatever mode is asked for", "[lua]") {
  CHECK(printed_by("print(load('\\27Lua', 'x', 'b'))").rfind("nil\t", 0) == 0);
  CHECK(printed_by("print(load('\\27Lua', 'x', 'bt'))").rfind("nil\t", 0) == 0);
  CHECK(printed_by("print(load(function() return nil end, 'x', 'b'))").rfind("function", 0) == 0);
  Script script("return require 'code'");
  script.write("code.lua", "\x1bLua");
  CHECK_THAT(script.error(), Contains("binary chunk"));
  CHECK_THAT(error_of("\x1bLuaT"), Contains("binary chunk"));
}

TEST_CASE("load runs text, in the environment it is given", "[lua]") {
  CHECK(printed_by("print(load('return a + 1', 'x', 't', { a = 2 })(), load('return 7')())") == "3\t7");
}

TEST_CASE("a script writes below its output folder only", "[lua]") {
  const std::string name = GENERATE(as<std::string>{}, "/tmp/cdem_escape", "../escape", "../../case.lua",
                                    "a/../../escape", "sub/../../../x", "..", "\\0");
  Script script("io.open('" + name + "', 'w')");
  INFO(name);
  CHECK_THAT(script.error(), Contains("case.lua:1: io.open: file"));
  CHECK_FALSE(fs::exists("/tmp/cdem_escape"));
  CHECK_FALSE(fs::exists(script.folder / "results" / "escape"));
}

TEST_CASE("the toolkit's own writers keep to the output folder too", "[lua]") {
  CHECK_THAT(
      error_of("require('cdem').write_csv{ file = '../x.csv', columns = { { name = 'a', values = {1} } } }"),
      Contains("must be inside the output folder"));
  CHECK_THAT(error_of(column() + "model:save{ file = '../x.vtu' }"),
             Contains("must be inside the output folder"));
  for (const std::string call : {"picture{ file = '/home/x.png' }", "save{ file = '../x.vtu' }",
                                 "film{ file = '../x.ogv', every = 1 }", "save_state{ file = '../x.cdem' }",
                                 "save_fragments{ file = '/x.csv' }"}) {
    Script check(column() + "model:" + call);
    check.settings.check_only = true;
    INFO(call);
    CHECK_THAT(check.error(), Contains("must be inside the output folder"));
  }
}

TEST_CASE("a link in the output folder leads nowhere", "[lua]") {
  Script script("io.open('link', 'w')");
  fs::create_symlink(script.folder / "case.lua", script.settings.output / "link");
  CHECK_THAT(script.error(), Contains("must be inside the output folder"));

  Script dangling("io.open('link', 'w')");
  fs::create_symlink(dangling.folder / "not_there_yet", dangling.settings.output / "link");
  CHECK_THAT(dangling.error(), Contains("must be inside the output folder"));
  CHECK_FALSE(fs::exists(dangling.folder / "not_there_yet"));

  Script folder("io.open('out/x', 'w')");
  fs::create_directory_symlink("/tmp", folder.settings.output / "out");
  CHECK_THAT(folder.error(), Contains("must be inside the output folder"));

  Script chain("io.open('a', 'w')");
  fs::create_symlink("b", chain.settings.output / "a");
  fs::create_symlink(chain.folder / "escape", chain.settings.output / "b");
  CHECK_THAT(chain.error(), Contains("must be inside the output folder"));
}

TEST_CASE("a script reads beside itself, in its output folder and below the results", "[lua]") {
  const std::string read = "print(io.open(name):read('a'))";
  Script beside("local name = 'data/x.txt'\n" + read);
  beside.write("data/x.txt", "beside");
  CHECK(beside.printed() == "beside");

  Script own("local f = io.open('x.txt', 'w')\nf:write('own')\nf:close()\nlocal name = 'x.txt'\n" + read);
  CHECK(own.printed() == "own");

  Script other("local name = 'results/other/x.txt'\n" + read);
  other.write("results/other/x.txt", "other");
  CHECK(other.printed() == "other");
}

TEST_CASE("a script reads nowhere else", "[lua]") {
  for (const std::string name : {"/etc/passwd", "../../../../../../../../etc/passwd", "/proc/self/environ"}) {
    CHECK_THAT(error_of("io.open('" + name + "')"), Contains("must be beside the script"));
    CHECK_THAT(error_of("for l in io.lines('" + name + "') do end"), Contains("must be beside the script"));
    CHECK_THAT(error_of("require('cdem').read_csv('" + name + "')"), Contains("must be beside the script"));
  }
  Script link("io.open('link')");
  fs::create_symlink("/etc/passwd", link.folder / "link");
  CHECK_FALSE(link.printed() == "x");
  CHECK(printed_by("print(io.open('missing.txt'))").rfind("nil\tfile \"missing.txt\": not found", 0) == 0);
}

TEST_CASE("require finds cdem and .lua files beside the script, once", "[lua]") {
  Script script("local a, b = require 'lib.tools', require 'lib.tools'\nprint(a.x, a == b, require('cdem') "
                "== require('cdem'))");
  script.write("lib/tools.lua", "return { x = 5 }");
  CHECK(script.printed() == "5\ttrue\ttrue");
}

TEST_CASE("require does not leave the script's folder", "[lua]") {
  CHECK_THAT(error_of("require '../x'"), Contains("must be letters, digits"));
  CHECK_THAT(error_of("require '/etc/x'"), Contains("must be letters, digits"));
  CHECK_THROWS_AS(error_of("require 'socket'"), FileError);
}

TEST_CASE("the metatables of our objects are out of reach", "[lua]") {
  CHECK(printed_by(column() + "print(getmetatable(model), getmetatable(rock), rawequal(rock, joint))") ==
        "false\tfalse\tfalse");
  CHECK_THAT(error_of(column() + "setmetatable(model, {})"), Contains("table expected"));
  CHECK_THAT(error_of(column() + "model.fix = 1"), Contains("case.lua:7: cdem.Model: fix: cannot be set"));
}

TEST_CASE("a file handle cannot pass for one of our objects", "[lua]") {
  Script script(column() + "local f = io.open('x', 'w')\n"
                           "for k, v in pairs({ __name = 'cdem.Model' }) do getmetatable(f)[k] = v end\n"
                           "model.counts(f)");
  script.settings.unsafe = true;
  CHECK_THAT(script.error(), Contains("call it with a colon on a cdem.Model"));
}

TEST_CASE("no metatable is in a safe script's reach: no finaliser runs, at the end or before", "[lua]") {
  const std::string file = "local value = io.open('x', 'w')\n";
  const std::string values = GENERATE_COPY(
      as<std::string>{}, file,
      "local value = io.lines('case.lua')\nvalue = select(4, io.lines('case.lua'))\n", "local value = ''\n",
      "local value = require 'cdem'\n", "local value = require('cdem').solid\n",
      "local value = require('cdem').solid.box{ size = {1, 1, 1} }\n", column() + "local value = model\n",
      column() + "local value = model.memory\n");
  INFO(values);
  CHECK(printed_by(values + "print(getmetatable(value))") == "false");
  const std::string finaliser = "local function bad() print 'finaliser' while true do end end\n";
  CHECK(printed_by(finaliser + values +
                   "print(pcall(function() getmetatable(value).__gc = bad end))\n"
                   "print(pcall(setmetatable, value, { __gc = bad }))\n"
                   "value = nil\ncollectgarbage()")
            .find("finaliser") == std::string::npos);
}

TEST_CASE("a script that takes more memory than allowed ends with a clear error", "[lua][.slow]") {
  CHECK_THAT(error_of("local s = ('x'):rep(2^30)\nlocal t = {}\nfor i = 1, 10 do t[i] = s .. i end"),
             Contains("need more than 4 GiB"));
}

TEST_CASE("the option --unsafe gives the whole library", "[lua]") {
  Script script("print(os.getenv('HOME') ~= nil, io.popen ~= nil, debug.getinfo(1).currentline)\n"
                "print(require('cdem').version ~= nil, require('tools').x)");
  script.write("tools.lua", "return { x = 5 }");
  script.settings.unsafe = true;
  CHECK(script.printed() == "true\ttrue\t1\ntrue\t5");
}

TEST_CASE("random numbers and the order of pairs are the same in every run", "[lua]") {
  const std::string text =
      "print(math.random(), math.random(1000))\n"
      "local t = { 3, 2, 1, beta = 1, alpha = 2, [10] = 1, [2.5] = 1, gamma = 3, [true] = 1 }\n"
      "local keys = {}\nfor k in pairs(t) do keys[#keys + 1] = tostring(k) end\n"
      "print(table.concat(keys, ' '))";
  const std::string first = printed_by(text);
  CHECK(first == printed_by(text));
  CHECK_THAT(first, Catch::Matchers::EndsWith("1 2 2.5 3 10 alpha beta gamma true"));
}
