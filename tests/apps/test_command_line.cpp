#include "tests/apps/support/child.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

Outcome cdem(const std::vector<std::string>& arguments) {
  static const TempFolder folder;
  Start start;
  start.folder = folder.path();
  return run_cdem(arguments, start);
}

} // namespace

TEST_CASE("help, version and info end with success") {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                    {"--help"},
                                                    {"-h"},
                                                    {"help"},
                                                    {"help", "run"},
                                                    {"run", "--help"},
                                                    {"sweep", "x.lua", "-h"},
                                                    {"--version"},
                                                    {"info"},
                                                    {"annotations"}}) {
    const Outcome outcome = cdem(arguments);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.err.empty());
    CHECK_FALSE(outcome.out.empty());
  }
}

TEST_CASE("the version is that of the project") {
  const std::string project = read_file(std::string(CDEM_SOURCE) + "/CMakeLists.txt");
  const std::string out = cdem({"--version"}).out;
  REQUIRE_THAT(out, StartsWith("cdem ") && Catch::Matchers::EndsWith("\n"));
  CHECK_THAT(project, Contains("VERSION " + out.substr(5, out.size() - 6) + " "));
}

TEST_CASE("help shows every command, examples and the exit codes") {
  const std::string help = cdem({"--help"}).out;
  for (const std::string command :
       {"run", "resume", "check", "sweep", "render", "info", "repl", "annotations"}) {
    CHECK_THAT(help, Contains("\n  " + command + " "));
    CHECK_THAT(cdem({"help", command}).out, Contains("usage: cdem " + command));
  }
  CHECK_THAT(help, Contains("examples:") && Contains("exit codes:") && Contains("130"));
}

TEST_CASE("a wrong command line is refused with the nearest right one") {
  const auto check = [](const std::vector<std::string>& arguments, const std::string& message) {
    const Outcome outcome = cdem(arguments);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, StartsWith("cdem: error: ") && Contains(message));
    CHECK(lines_of(outcome.err).size() == 1);
  };
  check({"rnu", "case.lua"}, "no command 'rnu'; did you mean run?");
  check({"chekc"}, "did you mean check?");
  check({"case.lua"}, "to run a script: cdem run case.lua");
  check({"help", "rnu"}, "did you mean run?");
  check({"run"}, "which file?");
  check({"run", "case.lua", "--thraeds", "2"}, "no option --thraeds; did you mean --threads?");
  check({"run", "case.lua", "--ouput=x"}, "did you mean --output?");
  check({"run", "case.lua", "-z"}, "no option -z");
  check({"run", "case.lua", "other.lua"}, "unexpected 'other.lua'");
  check({"run", "case.lua", "check", "other.lua"}, "unexpected 'check'");
  check({"run", "case.lua", "--threads"}, "--threads: its value is missing");
  check({"run", "case.lua", "--threads", "0"}, "--threads = 0: must be a whole number from 1 to 1024");
  check({"run", "case.lua", "--threads", "two"}, "--threads = two");
  check({"run", "case.lua", "--set", "pressure"}, "--set pressure: must be name=value");
  check({"run", "case.lua", "--set", "a=1", "--set", "a=2"}, "--set a is given twice");
  check({"--set", "a=1", "run", "case.lua"}, "--set belongs after the command: cdem run ... --set");
  check({"--verison"}, "no option --verison; did you mean --version?");
  check({"sweep", "case.lua"}, "nothing varies");
  check({"render", "a.vtu", "--size", "8x8"}, "--size = 8: must be a whole number from 64 to 8000");
  check({"render", "a.vtu", "--deformation", "much"}, "--deformation = much: must be a finite number");
  check({"render", "a.vtu", "--range", "3,1"}, "--range = 3,1");
  check({"info", "."}, "holds no cdem.log");
}

TEST_CASE("a mesh that meshio reads becomes one that cdem reads") {
  CHECK_THAT(cdem({"convert", "a.bdf", "b.msh"}).err, Contains("must end in .vtu or .stl"));
  CHECK(cdem({"convert", "missing.bdf", "b.vtu"}).exit_code == 4);

  const TempFolder folder;
  Start start;
  start.folder = folder.path();
  write_file(folder / "cubes.bdf",
             "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,0.,0.,1.\n"
             "GRID,5,,1.,1.,1.\nCTETRA,1,7,1,2,3,4\nCTETRA,2,9,2,5,3,4\nENDDATA\n");
  const Outcome made = run_cdem({"convert", "cubes.bdf", "cubes.vtu"}, start);
  if (made.err.find("apt install python3-meshio") != std::string::npos) {
    WARN("python3-meshio is not installed: cdem convert is not tried");
    return;
  }
  REQUIRE(made.exit_code == 0);
  CHECK_THAT(made.out, Contains("2 tetrahedra, 5 nodes, regions 7, 9"));
  // Corners of a unit cube: a sixth and a third of it.
  write_file(folder / "case.lua",
             "local cdem = require 'cdem'\nlocal m = cdem.read_mesh{ file = 'cubes.vtu' }\n"
             "assert(m.tets == 2 and math.abs(m:volume() - 1 / 2) < 1e-12)\n");
  CHECK(run_cdem({"run", "case.lua"}, start).exit_code == 0);

  write_file(folder / "bad.bdf", "not a mesh\n");
  const Outcome refused = run_cdem({"convert", "bad.bdf", "bad.vtu"}, start);
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, StartsWith("cdem: error: bad.bdf: "));
}

TEST_CASE("files that are missing end with exit code 4") {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"run", "none.lua"},
                                                    {"check", "none.lua"},
                                                    {"render", "none.vtu"},
                                                    {"info", "none.vtu"},
                                                    {"sweep", "none.lua", "--set", "a=1"}}) {
    const Outcome outcome = cdem(arguments);
    CHECK(outcome.exit_code == 4);
    CHECK_THAT(outcome.err, StartsWith("cdem: error: none.") && Contains("no such file"));
    CHECK(lines_of(outcome.err).size() == 1);
  }
}

TEST_CASE("a file that is no .vtu of ours is refused") {
  const TempFolder folder;
  write_file(folder / "broken.vtu", "<VTKFile>not really</VTKFile>");
  Start start;
  start.folder = folder.path();
  for (const std::string command : {"render", "info"}) {
    const Outcome outcome = run_cdem({command, "broken.vtu"}, start);
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, StartsWith("cdem: error: ") && Contains("broken.vtu"));
    CHECK(lines_of(outcome.err).size() == 1);
  }
}

TEST_CASE("an instruction set that is none, or that the processor lacks, ends with 2 and one line") {
  Start start;
  start.environment = {"CDEM_INSTRUCTION_SET=mmx"};
  const Outcome outcome = run_cdem({"info"}, start);
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("CDEM_INSTRUCTION_SET = mmx: must be baseline, avx2 or avx512"));
  CHECK(lines_of(outcome.err).size() == 1);
  start.environment = {"CDEM_INSTRUCTION_SET=baseline"};
  CHECK_THAT(run_cdem({"info"}, start).out, Contains("baseline unless"));
}
