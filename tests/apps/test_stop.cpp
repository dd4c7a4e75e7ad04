// One Ctrl-C ends whatever a script is in within two seconds, with a closed log; a limit of memory ends in one line.
#include "tests/apps/support/child.hpp"

#include <catch2/catch.hpp>

#include <csignal>

using namespace testing;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

constexpr double in_time = 3; // s: two, and one for a busy machine

// Runs the text, which prints "begins", and stops it there.
Outcome stopped(const TempFolder& folder, const std::string& text,
                std::vector<std::string> arguments = {"run"}, int signal = SIGINT) {
  if (!text.empty())
    write_file(folder / "case.lua", text);
  Start start;
  start.folder = folder.path();
  start.signal = signal;
  start.signal_after = "begins";
  if (arguments.size() == 1)
    arguments.push_back("case.lua");
  if (arguments[0] == "run")
    arguments.insert(arguments.end(), {"--output", "out"});
  const Outcome outcome = run_cdem(arguments, start);
  INFO(text << outcome.out << outcome.err);
  CHECK(outcome.exit_code == (signal == SIGTERM ? 143 : 130));
  CHECK(outcome.after_signal < in_time);
  REQUIRE(lines_of(outcome.err).size() == 1);
  CHECK_THAT(outcome.err, Contains(signal == SIGTERM ? "cdem: error: stopped by SIGTERM"
                                                     : "cdem: error: stopped by Ctrl-C"));
  return outcome;
}

const std::string prints = "print 'begins'\n", module = "local cdem = require 'cdem'\n";

const std::string endless_pattern = "string.find(('a'):rep(40000), ('.-'):rep(20) .. 'b')\n";

} // namespace

TEST_CASE("Ctrl-C ends what Lua's own functions never come back from, and says where it stood") {
  for (const std::string& text :
       {endless_pattern, std::string("string.gsub(('a'):rep(100000), ('.-'):rep(20) .. 'b', '')"),
        std::string("table.move({}, 1, 1 << 60, 2)"),
        std::string("pcall(table.concat, {}, '', 1, 1 << 40)\n"
                    "table.move({}, 1, 1 << 60, 2)")}) {
    const TempFolder folder;
    const Outcome outcome = stopped(folder, prints + text);
    CHECK_THAT(outcome.err, Contains("while busy at case.lua:"));
    const std::string log = read_file(folder / "out/cdem.log");
    CHECK_THAT(log, Contains("error: stopped by Ctrl-C while busy at case.lua:"));
    CHECK_THAT(log, Contains("ended with exit code 130"));
  }
}

TEST_CASE("Ctrl-C ends sorting, closing and coroutines that never end") {
  const std::string closing = "setmetatable({}, { __close = function() while true do end end })";
  for (const std::string& text : {
           std::string("local t = setmetatable({}, { __len = function() return 1 << 30 end,\n"
                       "  __index = function() return 1 end, __newindex = function() end })\n"
                       "table.sort(t, function() return false end)"),
           "local x <close> = " + closing + "\nwhile true do end",
           "coroutine.resume(coroutine.create(function() local x <close> = " + closing +
               "\nwhile true do end end))",
           "local c = coroutine.create(function() local x <close> = " + closing +
               "\nerror 'x' end)\ncoroutine.resume(c)\ncoroutine.close(c)",
       })
    stopped(TempFolder(), prints + text);
}

TEST_CASE("Ctrl-C ends builders: voronoi of 300,000, a mesh of millions of tetrahedra, joints") {
  for (const std::string text :
       {"cdem.voronoi{ size = {1, 1, 1}, count = 300000 }",
        "cdem.solid.box{ size = {1, 1, 1} }:mesh{ size = 0.012 }",
        "cdem.cut_by_joints{ shape = cdem.grid{ size = {1, 1, 1}, divisions = {40, 40, 40} },\n"
        "  sets = { { dip = 31, dip_direction = 10, spacing = 0.01 } } }"})
    stopped(TempFolder(), module + prints + text);
}

TEST_CASE("Ctrl-C ends a check, and SIGTERM a run, that never come back") {
  stopped(TempFolder(), prints + endless_pattern, {"check"});
  stopped(TempFolder(), prints + endless_pattern, {"run"}, SIGTERM);
}

TEST_CASE("a run that is stopped where it never comes back keeps what it had solved") {
  const std::string solved =
      module +
      "local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0, density = 2000 }\n"
      "local joint = cdem.mohr_coulomb{ cohesion = 1e9, friction_angle = 30, tensile_strength = 1e9 }\n"
      "local model = cdem.model{ bodies = { { shape = cdem.grid{ size = {2, 1, 1}, divisions = {2, 1, 1} "
      "},\n  material = rock, joint = joint } } }\n"
      "model:fix{ on = 'x-' }\nmodel:traction{ on = 'x+', stress = {1e5, 0, 0} }\n"
      "model:run{ steps = 400 }\nprint('begins', model.state_hash)\n";
  // By itself, and in a function that a call was given.
  for (const std::string& stuck :
       {endless_pattern,
        "model:mean('displacement.x', cdem.select.where(function() " + endless_pattern + "end))\n"}) {
    const TempFolder folder;
    stopped(folder, solved + stuck);
    CHECK_THAT(read_file(folder / "out/cdem.log"), Contains("checkpoint; to go on: cdem resume out"));
    REQUIRE(fs::exists(folder / "out/checkpoint_1.cdem"));
    Start start;
    start.folder = folder.path();
    start.signal = SIGINT;
    start.signal_after = "goes on";
    const Outcome again = run_cdem({"resume", "out"}, start);
    CHECK(again.exit_code == 130);
    CHECK(again.after_signal < in_time);
    CHECK_THAT(again.out, Contains("goes on from out/checkpoint_1.cdem, stage 1"));
  }
}

TEST_CASE("a limit of memory ends in one line") {
  const TempFolder folder;
  Start start;
  start.folder = folder.path();
  for (const auto& [text, reason] : std::vector<std::pair<std::string, std::string>>{
           {"local t = {}\nfor i = 1, 1e9 do t[i] = i end",
            "case.lua: the script's own tables and strings need "
            "more than 100 MiB"},
           {module + "cdem.voronoi{ size = {1, 1, 1}, count = 300000 }",
            "case.lua:2: cdem.voronoi: not enough memory"},
           {module + "cdem.grid{ size = {1, 1, 1}, divisions = {200, 200, 200} }",
            "case.lua:2: cdem.grid: not enough memory"},
           {module + "cdem.solid.box{ size = {1, 1, 1} }:mesh{ size = 0.013 }",
            "case.lua:2: solid:mesh: "}}) {
    write_file(folder / "case.lua", text);
    const Outcome outcome = run_cdem({"check", "case.lua", "--memory", "100M"}, start);
    INFO(text << "\n" << outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(lines_of(outcome.err).size() == 1);
    CHECK_THAT(outcome.err, Contains(reason));
    CHECK(outcome.peak_memory < 600e6);
  }
  for (const std::string wrong : {"x", "-1G", "1M", "1GG", "nan"})
    CHECK_THAT(run_cdem({"check", "case.lua", "--memory", wrong}, start).err, Contains("--memory = "));
}

TEST_CASE("a model that needs more memory than there may be is warned of before it is built or cut, for each "
          "rank") {
  const TempFolder folder;
  Start start;
  start.folder = folder.path();
  write_file(
      folder / "case.lua",
      module +
          "local n = cdem.parameter{ name = 'n', default = 14 }\n"
          "local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }\n"
          "local joint = cdem.mohr_coulomb{ cohesion = 6e5, friction_angle = 30, tensile_strength = 2e5 }\n"
          "local model = cdem.model{ bodies = { { shape = cdem.grid{ size = {1, 1, 1}, divisions = {n, n, n} "
          "},\n"
          "  material = rock, joint = joint, name = 'plate', element = 'small_strain' } } }\n"
          "model:fix{ on = 'y-' }\n"
          "model:refine{ tension_threshold = 0.5, shear_threshold = 0.5 }");
  const auto warned = [&](const std::string& memory, const std::string& ranks) {
    return run_cdem({"run", "case.lua", "--output", "out", "--memory", memory, "--ranks", ranks}, start).err;
  };
  // 2744 blocks of 24 tets: 64 MB to build, 105 MB to cut.
  CHECK(warned("2G", "1").empty());
  CHECK_THAT(warned("90M", "1"),
             !Contains("building this model takes") &&
                 Contains("case.lua:8: warning: cutting this model takes some 105 MB of memory in this "
                          "process, which may take 94 MB"));
  // Whether it is enough in the end or not.
  CHECK_THAT(run_cdem({"check", "case.lua", "--memory", "90M", "--set", "n=17"}, start).err,
             Contains("warning: building this model takes some 114 MB"));
  if (no_mpirun())
    return;
  CHECK(warned("2G", "2").empty());
  CHECK_THAT(warned("180M", "2"), !Contains("building this model takes") &&
                                      Contains("in each of 2 ranks, which may take 94 MB") &&
                                      Contains("start fewer ranks on a machine"));
}

TEST_CASE("runs of a sweep share what it may take") {
  const TempFolder folder;
  Start start;
  start.folder = folder.path();
  write_file(folder / "one.lua", module + "cdem.parameter{ name = 'x', default = 0 }\n"
                                          "local t = {}\nfor i = 1, 2e7 do t[i] = i end");
  write_file(folder / "all.lua",
             module + "cdem.sweep{ script = 'one.lua', set = { { x = 1 }, { x = 2 } }, jobs = 2 }");
  CHECK(run_cdem({"run", "all.lua", "--output", "a", "--memory", "3G"}, start).exit_code == 0);
  CHECK_THAT(read_file(folder / "a/x=1/cdem.log"), Contains("exit code 0"));
  run_cdem({"run", "all.lua", "--output", "b", "--memory", "300M"}, start);
  std::string logs;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "b"))
    if (entry.path().extension() == ".log" || entry.path().extension() == ".txt")
      logs += read_file(entry.path());
  CHECK_THAT(logs, Contains("more than 150 MiB"));
}

TEST_CASE("a picture for which memory is short is left out with a warning, and the report is written") {
  const TempFolder folder;
  write_file(folder / "case.lua",
             module +
                 "local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0, density = 2000 }\n"
                 "local model = cdem.model{ bodies = { { shape = cdem.box_mesh{ size = {1, 1, 1}, divisions "
                 "= {2, 2, 2} "
                 "}, material = rock } } }\n"
                 "model:picture{ file = 'a.png', colour = 'displacement.x' }\n"
                 "cdem.chart{ file = 'b.png', series = { { name = 's', x = {0, 1}, y = {0, 1} } } }\n"
                 "cdem.report{ { name = 'blocks', value = model:counts().blocks } }\n");
  Start start;
  start.folder = folder.path();
  start.environment = {std::string("CDEM=") + CDEM_PROGRAM};
  for (const std::string limit : {"ulimit -v 800000; exec $CDEM run case.lua --output out",
                                  "exec $CDEM run case.lua --output out --memory 150M"}) {
    const Outcome outcome = run_program({"/bin/sh", "-c", limit}, start);
    INFO(limit << "\n" << outcome.out << outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK(lines_of(outcome.err).size() == 2);
    CHECK_THAT(outcome.err, Contains("case.lua:4: warning: a.png is not drawn: it needs about ") &&
                                Contains("case.lua:5: warning: b.png is not drawn: it needs about "));
    CHECK_FALSE(fs::exists(folder / "out/a.png"));
    CHECK_THAT(read_file(folder / "out/report.json"), Contains("blocks"));
  }
}
