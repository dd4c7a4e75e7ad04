#include "tests/apps/support/case_folder.hpp"

#include <catch2/catch.hpp>
#include <csignal>

using namespace testing;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;
namespace fs = std::filesystem;

namespace {

// A bar that is pressed until it is still.
const char* const bar = R"(
local cdem = require "cdem"
local load = cdem.parameter{ name = "pressure", default = 1e6, range = {0, 1e9}, unit = "Pa", doc = "on the top" }
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6 }
local shape = cdem.grid{ size = {0.2, 0.4, 0.2}, divisions = {2, 4, 2} }
local model = cdem.model{ bodies = { { shape = shape, material = rock, joint = joint, name = "bar" } } }
model:fix{ on = "y-", axes = "xyz" }
model:traction{ on = "y+", stress = {0, -load, 0} }
print "the bar stands"
model:relax{ residual = 1e-4, breaking = false }
model:save{ file = "bar.vtu" }
cdem.report{ { name = "top_uy_mean_m", value = model:mean("displacement.y", "y+"), unit = "m", kind = "trial" } }
)";

// One that runs in real time until it is stopped.
const char* const endless = R"(
local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6 }
local shape = cdem.grid{ size = {0.2, 0.4, 0.2}, divisions = {2, 4, 2} }
local model = cdem.model{ bodies = { { shape = shape, material = rock, joint = joint } } }
model:fix{ on = "y-", axes = "xyz" }
model:traction{ on = "y+", stress = {0, -1e6, 0} }
print "begins"
model:run{ duration = 1e6, breaking = false }
)";

struct Place : CaseFolder {
  Place() : CaseFolder({{"bar/case.lua", bar}, {"bar/endless.lua", endless}}) {}
};

} // namespace

TEST_CASE("a run leaves results, report, settings, script and log in results/<case>") {
  const Place cdem;
  const Outcome outcome = cdem({"run", "bar/case.lua", "--threads", "2"});
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  CHECK_THAT(outcome.out, Contains("the bar stands") && Contains("stage 1 relax: ") &&
                              EndsWith("results in results/bar\n"));
  CHECK_THAT(outcome.out, !Contains("\033"));
  const fs::path results = cdem.folder / "results/bar";
  for (const std::string name : {"bar.vtu", "bar_bonds.vtu", "report.json", "report.md", "history.csv"})
    CHECK(fs::file_size(results / name) > 0);
  CHECK(read_file(results / "case.lua") == bar);
  CHECK_THAT(read_file(results / "settings.json"),
             Contains("\"pressure\"") && Contains("1000000") && Contains("\"threads\": 2"));
  const std::string log = read_file(results / "cdem.log");
  CHECK_THAT(log, StartsWith("cdem log 1: cdem ") && Contains("cdem run bar/case.lua --threads 2") &&
                      Contains("2 threads") && Contains("the bar stands") && Contains("stage 1 relax: ") &&
                      Contains(" bar.vtu\n") && Contains("ended with exit code 0"));
}

TEST_CASE("settings have folders of their own") {
  const Place cdem;
  CHECK(cdem({"run", "bar/case.lua", "--quiet"}).exit_code == 0);
  CHECK(cdem({"run", "bar/case.lua", "--quiet", "--set", "pressure=2e6"}).exit_code == 0);
  CHECK(fs::exists(cdem.folder / "results/bar/report.json"));
  CHECK(fs::exists(cdem.folder / "results/bar-pressure=2e6/report.json"));
}

TEST_CASE("a quiet run prints nothing, and its log everything") {
  const Place cdem;
  const Outcome outcome = cdem({"run", "bar/case.lua", "-q", "-o", "out"});
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.out.empty());
  CHECK(outcome.err.empty());
  CHECK_THAT(read_file(cdem.folder / "out/cdem.log"), Contains("the bar stands"));
}

TEST_CASE("a rerun takes its own old files away, and a script with a mistake does not cost them") {
  const Place cdem;
  REQUIRE(cdem({"run", "bar/case.lua", "-q"}).exit_code == 0);
  const fs::path results = cdem.folder / "results/bar";
  write_file(results / "notes.txt", "mine");
  write_file(cdem.folder / "bar/case.lua", std::string(bar) + "\nmistake(\n");
  CHECK(cdem({"run", "bar/case.lua", "-q"}).exit_code == 2);
  CHECK(fs::exists(results / "bar.vtu"));
  CHECK(fs::exists(results / "failed.log"));
  write_file(cdem.folder / "bar/case.lua", "print 'nothing else'\n");
  CHECK(cdem({"run", "bar/case.lua", "-q"}).exit_code == 0);
  CHECK_FALSE(fs::exists(results / "bar.vtu"));
  CHECK_FALSE(fs::exists(results / "bar_bonds.vtu"));
  CHECK_FALSE(fs::exists(results / "failed.log"));
  CHECK(read_file(results / "notes.txt") == "mine");
}

TEST_CASE("a check prints parameters and model, and leaves nothing behind") {
  const Place cdem;
  const Outcome outcome = cdem({"check", "bar/case.lua", "--set", "pressure=2e6"});
  INFO(outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out,
             Contains("pressure") && (Contains("2e+06") || Contains("2e6") || Contains("2000000")));
  CHECK_THAT(outcome.out, Contains("on the top") && Contains("16 blocks") && Contains("no errors found"));
  CHECK_FALSE(fs::exists(cdem.folder / "results"));
}

TEST_CASE("info tells about a script, a .vtu and a results folder") {
  const Place cdem;
  REQUIRE(cdem({"run", "bar/case.lua", "-q"}).exit_code == 0);
  CHECK_THAT(cdem({"info", "bar/case.lua"}).out, Contains("pressure") && Contains("on the top"));
  CHECK_THAT(cdem({"info", "results/bar/bar.vtu"}).out,
             Contains("displacement") && Contains("stress") && Contains("Pa"));
  const Outcome folder = cdem({"info", "results/bar"});
  CHECK(folder.exit_code == 0);
  CHECK_THAT(folder.out, Contains("with exit code 0") && Contains("top_uy_mean_m") && Contains("bar.vtu"));
}

TEST_CASE("render draws a .vtu without a display") {
  Place cdem;
  cdem.start.environment = {"DISPLAY="};
  REQUIRE(cdem({"run", "bar/case.lua", "-q"}).exit_code == 0);
  const std::string vtu = "results/bar/bar.vtu";
  const Outcome outcome =
      cdem({"render", vtu, "--colour", "displacement.y", "--size", "320x240", "--deformation", "100",
            "--range", "-1e-4,0", "--view", "iso", "--output", "uy.png"});
  INFO(outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.out == "uy.png\n");
  CHECK_THAT(read_file(cdem.folder / "uy.png"), StartsWith("\x89PNG"));
  CHECK(cdem({"render", vtu, "--size", "320x240"}).exit_code == 0);
  CHECK(fs::exists(cdem.folder / "results/bar/bar-displacement.magnitude.png"));
  CHECK(cdem({"render", vtu, "--output", "nowhere/uy.png"}).exit_code == 4);
  const Outcome wrong = cdem({"render", vtu, "--colour", "displacment.y"});
  CHECK(wrong.exit_code == 2);
  CHECK_THAT(wrong.err, Contains("displacement.y"));
}

TEST_CASE("render leaves out the bodies it is told to") {
  const TempFolder folder;
  write_file(folder / "case.lua",
             "local cdem = require 'cdem'\n"
             "local rock = cdem.elastic{ density = 2500, youngs_modulus = 3e10, poissons_ratio = 0.25 }\n"
             "local function cube(name, x)\n"
             "  return { shape = cdem.cube{ height = 1 }:translate{ shift = {x, 0, 0} }:mesh{ size = 1 },\n"
             "           material = rock, name = name }\n"
             "end\n"
             "local model = cdem.model{ bodies = { cube('one', 0), cube('two', 2) } }\n"
             "model:save{ file = 'two.vtu' }\n");
  Start start;
  start.folder = folder.path();
  const Outcome ran = run_cdem({"run", "case.lua", "--output", "out"}, start);
  INFO(ran.err);
  REQUIRE(ran.exit_code == 0);
  const auto drawn = [&](const std::string& hide) {
    std::vector<std::string> line{"render", "out/two.vtu", "--size", "320x240", "-c", "body", "-o", "p.png"};
    if (!hide.empty())
      line.insert(line.end(), {"--hidden", hide});
    return run_cdem(line, start);
  };
  REQUIRE(drawn("").exit_code == 0);
  const std::string both = read_file(folder / "p.png");
  REQUIRE(drawn("1").exit_code == 0);
  const std::string first = read_file(folder / "p.png");
  CHECK(first != both);
  REQUIRE(drawn("0").exit_code == 0);
  CHECK(read_file(folder / "p.png") != both);
  CHECK(read_file(folder / "p.png") != first);
  REQUIRE(drawn("two").exit_code == 0);
  CHECK(read_file(folder / "p.png") == first);
  const std::string known = ": must be a body of the file, by name or number: 0 one, 1 two";
  for (const auto& [hide, said] : {std::pair<std::string, std::string>("5", "--hidden = 5" + known),
                                   {"x", "--hidden = x" + known},
                                   {"0,,two", "--hidden = 0,,two: must be NAME,..."},
                                   {"0,two", "nothing would be left to draw"}}) {
    const Outcome refused = drawn(hide);
    CHECK(refused.exit_code == 2);
    CHECK_THAT(refused.err, Contains(said));
  }
  CHECK_THAT(run_cdem({"info", "out/two.vtu"}, start).out, Contains("0 one, 1 two"));
}

TEST_CASE("a run on a terminal shows one live line that goes when it ends") {
  Place cdem;
  cdem.start.terminal = true;
  cdem.start.columns = 60;
  cdem.start.signal = SIGINT;
  cdem.start.signal_after = "steps"; // some way into the stage
  cdem.start.limit = 30;
  cdem.start.signal_after = "stage 1 run";
  const Outcome outcome = cdem({"run", "bar/endless.lua"});
  CHECK(outcome.exit_code == 130);
  CHECK(outcome.after_signal < 2);
  CHECK_THAT(outcome.out, Contains("\r\033[Kstage 1 run  "));
  // The line is taken back before the next thing is printed.
  CHECK_THAT(outcome.out, Contains("\r\033[Kcheckpoint; to go on: cdem resume results/bar-endless") &&
                              Contains("the last good state") &&
                              Contains("cdem: error: stopped by Ctrl-C\r\n"));
  for (auto at = outcome.out.find("\r\033[K"); at != std::string::npos;
       at = outcome.out.find("\r\033[K", at + 1)) {
    const auto from = at + 4;
    const auto to = std::min(outcome.out.find('\r', from), outcome.out.size());
    CHECK(to - from < 60);
  }
}

TEST_CASE("a layer of units shows how far it is laid, and Ctrl-C ends it with what was solved kept") {
  const TempFolder folder;
  write_file(
      folder / "case.lua",
      "local cdem = require 'cdem'\n"
      "local rock = cdem.elastic{ density = 2500, youngs_modulus = 3e10, poissons_ratio = 0.25 }\n"
      "local cube = { shape = cdem.cube{ height = 1 }:mesh{ size = 1 }, material = rock, name = 'cube' }\n"
      "local model = cdem.model{ bodies = { cube } }\n"
      "model:fix{ on = 'z-' }\n"
      "model:gravity{ vector = {0, 0, -9.81} }\n"
      "model:relax{}\n"
      "local unit = cdem.accropode{ height = 1, corner = 0 }:mesh{ size = 0.5 }\n"
      "local slope = cdem.slope{ gradient = 2 / 3, length = 40, width = 40 }:mesh{ size = 3 }\n"
      "cdem.place{ unit = unit, count = 900, onto = slope, columns = 20 }\n");
  Start start;
  start.folder = folder.path();
  start.terminal = true;
  start.columns = 120;
  start.signal = SIGINT;
  start.signal_after = "laid, spacing 1 of at most 2";
  start.limit = 60;
  const Outcome outcome = run_cdem({"run", "case.lua", "--output", "out"}, start);
  CHECK(outcome.exit_code == 130);
  CHECK(outcome.after_signal < 3);
  CHECK_THAT(outcome.out, Contains("\r\033[Kplace  [") && Contains("laid, spacing 1 of at most 2") &&
                              Contains("stopped by Ctrl-C") && Contains("cdem resume out"));
  CHECK(fs::exists(folder / "out/checkpoint_1.cdem"));
}

TEST_CASE("a run that is stopped leaves what it had reached") {
  Place cdem;
  cdem.start.signal = SIGTERM;
  cdem.start.signal_after = "begins";
  const Outcome outcome = cdem({"run", "bar/endless.lua"});
  CHECK(outcome.exit_code == 143);
  CHECK(outcome.after_signal < 2);
  const fs::path results = cdem.folder / "results/bar-endless";
  CHECK(fs::file_size(results / "last_good.vtu") > 1000);
  CHECK(fs::exists(results / "history.csv"));
  CHECK_THAT(read_file(results / "cdem.log"), Contains("ended with exit code 143"));
}

TEST_CASE("a warning is seen on stderr of a quiet run, in the log, in the closing line and by info") {
  const Place cdem;
  std::string text = bar;
  const std::string goal = "residual = 1e-4";
  text.replace(text.find(goal), goal.size(), "max_steps = 3");
  write_file(cdem.folder / "bar/short.lua", text);
  const Outcome quiet = cdem({"run", "bar/short.lua", "-q"});
  CHECK(quiet.exit_code == 0);
  CHECK(quiet.out.empty());
  REQUIRE(lines_of(quiet.err).size() == 1);
  CHECK_THAT(quiet.err, StartsWith("bar/short.lua:11: warning: relax: undecided after 3 steps"));
  const Outcome loud = cdem({"run", "bar/short.lua"});
  CHECK(loud.err == quiet.err);
  CHECK_THAT(loud.out, EndsWith("1 warning; results in results/bar-short\n"));
  CHECK_THAT(read_file(cdem.folder / "results/bar-short/cdem.log"), Contains("warning: relax: undecided"));
  CHECK_THAT(read_file(cdem.folder / "results/bar-short/report.json"), Contains("warning: relax: undecided"));
  CHECK_THAT(cdem({"info", "results/bar-short"}).out, Contains("warnings  1, in cdem.log"));
}

TEST_CASE("each stage tells what broke in it, and the closing line what broke in all") {
  const Place cdem;
  write_file(cdem.folder / "pull.lua", R"(
local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 8e9, friction_angle = 30, tensile_strength = 1e5 }
local shape = cdem.grid{ size = {2, 1, 1}, divisions = {2, 1, 1} }
local model = cdem.model{ bodies = { { shape = shape, material = rock, joint = joint } } }
model:fix{ on = {"x-", "x+"}, axes = "xyz" }
model:fix{ on = "x+", axes = "x", displacement = {1e-4, 0, 0} }
model:relax{}
model:run{ steps = 10 }
)");
  const Outcome outcome = cdem({"run", "pull.lua", "-o", "out"});
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const auto lines = lines_of(outcome.out);
  REQUIRE(lines.size() == 3);
  CHECK_THAT(lines[0], StartsWith("stage 1 relax: ") && EndsWith(", 5 broken (5 tension, 0 shear)"));
  CHECK_THAT(lines[1], StartsWith("stage 2 run: 10 steps") && EndsWith(", 0 broken"));
  CHECK(lines[2] == "5 broken (5 tension, 0 shear); results in out");
}

TEST_CASE("a file that cannot be written ends with exit code 4 and one line that names it") {
  const Place cdem;
  const std::string model = std::string(bar).substr(0, std::string(bar).find("model:relax"));
  const auto ends = [&](const std::string& line, const std::string& file) {
    write_file(cdem.folder / "bar/write.lua", model + line);
    const Outcome outcome = cdem({"run", "bar/write.lua", "-q"});
    INFO(line << ": " << outcome.err);
    CHECK(outcome.exit_code == 4);
    CHECK(lines_of(outcome.err).size() == 1);
    CHECK_THAT(outcome.err, StartsWith("cdem: error: ") && Contains(file));
  };
  ends("io.open('file', 'w'):write('x'):close()\nmodel:save{ file = 'file/a.vtu' }", "file");
  ends("io.open('file', 'w'):write('x'):close()\nmodel:picture{ file = 'file/a.png', size = {320, 240} }",
       "file");
}

TEST_CASE("a full disk ends with exit code 4 and one line") {
  const Place cdem;
  const auto [call, file] =
      GENERATE(std::pair<std::string, std::string>{"model:save{ file = 'a.vtu' }", "a.vtu"},
               std::pair<std::string, std::string>{"model:picture{ file = 'a.png' }", "a.png"});
  write_file(cdem.folder / "bar/full.lua",
             std::string(bar).substr(0, std::string(bar).find("model:relax")) + call + "\n");
  // No file may grow beyond 4 KiB: the log fits, the model does not.
  const Outcome outcome =
      run_program({"/bin/bash", "-c",
                   std::string("trap '' XFSZ; ulimit -f 4; exec ") + CDEM_PROGRAM + " run bar/full.lua -q"},
                  cdem.start);
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == 4);
  CHECK(lines_of(outcome.err).size() == 1);
  CHECK_THAT(outcome.err, Contains(file + " cannot be written"));
  CHECK_FALSE(fs::exists(cdem.folder / "results/bar-full" / file));
  CHECK_FALSE(fs::exists(cdem.folder / "results/bar-full" / (file + ".part")));
}

TEST_CASE("a check shows the model's box, also when it fails further down") {
  const Place cdem;
  const std::string box = "box from {0, 0, 0} to {0.2, 0.4, 0.2} m, size {0.2, 0.4, 0.2} m";
  CHECK_THAT(cdem({"check", "bar/case.lua"}).out, Contains(box));
  write_file(cdem.folder / "bar/outside.lua",
             std::string(bar) + "model:probe{ name = 'p', field = 'stress.yy', at = {0.1, 0.5, 0.1} }\n");
  const Outcome outcome = cdem({"check", "bar/outside.lua"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.out, Contains(box) && !Contains("no errors found"));
  CHECK(lines_of(outcome.err).size() == 1);
  CHECK_THAT(outcome.err, Contains("the model's box is from (0, 0, 0) to (0.2, 0.4, 0.2) m"));
}

TEST_CASE("a setting that cannot be read leaves no folder behind, and takes none of the user's") {
  const Place cdem;
  CHECK(cdem({"run", "bar/case.lua", "-q", "--set", "pressure=ten"}).exit_code == 2);
  CHECK_FALSE(fs::exists(cdem.folder / "results"));
  fs::create_directories(cdem.folder / "mine");
  CHECK(cdem({"run", "bar/case.lua", "-q", "--set", "pressure=ten", "-o", "mine/a/b"}).exit_code == 2);
  CHECK(fs::exists(cdem.folder / "mine"));
  CHECK_FALSE(fs::exists(cdem.folder / "mine/a"));
}

TEST_CASE("info of a file of bonds names the file that it belongs to") {
  const Place cdem;
  REQUIRE(cdem({"run", "bar/case.lua", "-q"}).exit_code == 0);
  const Outcome outcome = cdem({"info", "results/bar/bar_bonds.vtu"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("holds the bonds of results/bar/bar.vtu; give that file"));
}

TEST_CASE("a check prints what a script says before it solves, and nothing made of empty results") {
  const Place cdem;
  write_file(cdem.folder / "bar/says.lua",
             std::string(bar) + "print('top moved by', model:max('displacement.y'))\n");
  const Outcome outcome = cdem({"check", "bar/says.lua"});
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("the bar stands") && !Contains("top moved"));
  CHECK_THAT(cdem({"run", "bar/says.lua"}).out, Contains("top moved"));
}

TEST_CASE("cdem.log tells where the time of a stage's steps went") {
  const Place cdem;
  REQUIRE(cdem({"run", "bar/case.lua", "--output", "there"}).exit_code == 0);
  std::string told;
  for (const auto& line : lines_of(read_file(cdem.folder / "there/cdem.log")))
    if (const auto at = line.find("time of the steps: "); at != std::string::npos)
      told = line.substr(at);
  CHECK_THAT(told, Contains("elements ") && Contains("bonds ") && Contains(" %"));
}
