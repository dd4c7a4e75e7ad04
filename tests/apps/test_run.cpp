#include "tests/apps/support/child.hpp"

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

struct Place {
  TempFolder folder;
  Start start;
  Place() {
    start.folder = folder.path();
    write_file(folder / "bar/case.lua", bar);
    write_file(folder / "bar/endless.lua", endless);
  }
  Outcome operator()(const std::vector<std::string>& arguments) const { return run_cdem(arguments, start); }
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
             Contains("pressure") && Contains("2e+06") || Contains("2e6") || Contains("2000000"));
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
  CHECK_THAT(outcome.out,
             Contains("\r\033[Kthe last good state") && Contains("cdem: error: stopped by Ctrl-C\r\n"));
  for (auto at = outcome.out.find("\r\033[K"); at != std::string::npos;
       at = outcome.out.find("\r\033[K", at + 1)) {
    const auto from = at + 4;
    const auto to = std::min(outcome.out.find('\r', from), outcome.out.size());
    CHECK(to - from < 60);
  }
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
