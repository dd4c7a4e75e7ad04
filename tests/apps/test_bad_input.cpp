// A tour of bad input: every script of bad_input/ is run by the real program and must end with its exit code
// and one clear line. A script says itself what it expects:
//
//     -- exit code: 2
//     -- says: density = -2500: must be > 0        part of the line; there may be several
//     -- arguments: --set pressure=-1              of cdem run, behind the script
//     cdem.elastic{ ... } -- wrong                 the line that the message must name
#include "tests/apps/support/child.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <sstream>
#include <sys/stat.h>

using namespace testing;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
namespace fs = std::filesystem;

namespace {

struct Expectation {
  int exit_code = -1;
  std::vector<std::string> says, arguments;
  int wrong_line = 0; // 0: the message names none
};

// What follows `key` at the start of a line, or "".
std::string after(const std::string& line, const std::string& key) {
  return line.compare(0, key.size(), key) == 0 ? line.substr(key.size()) : std::string();
}

Expectation expectation_of(const fs::path& script) {
  Expectation expected;
  int number = 0;
  for (const auto& line : lines_of(read_file(script))) {
    ++number;
    if (const auto code = after(line, "-- exit code: "); !code.empty())
      expected.exit_code = std::stoi(code);
    if (const auto part = after(line, "-- says: "); !part.empty())
      expected.says.push_back(part);
    std::istringstream words(after(line, "-- arguments: "));
    for (std::string word; words >> word;)
      expected.arguments.push_back(word);
    if (line.find("-- wrong") != std::string::npos)
      expected.wrong_line = number;
  }
  return expected;
}

// The tour in a folder of its own, with the scripts in bad_input/.
struct Tour {
  TempFolder folder;
  std::vector<fs::path> scripts;
  Tour() {
    fs::copy(fs::path(CDEM_SOURCE) / "tests/apps/bad_input", folder / "bad_input");
    for (const auto& entry : fs::directory_iterator(folder / "bad_input"))
      if (expectation_of(entry.path()).exit_code >= 0)
        scripts.push_back(entry.path());
    std::sort(scripts.begin(), scripts.end());
  }
  Outcome run(const std::vector<std::string>& arguments) const {
    Start start;
    start.folder = folder.path();
    start.limit = 20;
    return run_cdem(arguments, start);
  }
};

void check_one_clear_line(const Outcome& outcome) {
  const auto lines = lines_of(outcome.err);
  REQUIRE(lines.size() == 1);
  CHECK_THAT(lines[0], StartsWith("cdem: error: "));
  CHECK_THAT(outcome.out + outcome.err, !Contains("traceback") && !Contains("terminate"));
  CHECK_FALSE(outcome.timed_out);
}

constexpr double most_memory = 1e9; // bytes; a wrong number must not take the machine's memory

} // namespace

TEST_CASE("every wrong script ends with its exit code and one clear line") {
  const Tour tour;
  REQUIRE(tour.scripts.size() >= 50);
  for (const auto& script : tour.scripts) {
    const std::string name = script.filename().string();
    const Expectation expected = expectation_of(script);
    std::vector<std::string> arguments = {"run", "bad_input/" + name};
    arguments.insert(arguments.end(), expected.arguments.begin(), expected.arguments.end());
    const Outcome outcome = tour.run(arguments);
    INFO(name << " says: " << outcome.err);
    CHECK(outcome.exit_code == expected.exit_code);
    check_one_clear_line(outcome);
    if (expected.wrong_line > 0)
      CHECK_THAT(outcome.err,
                 Contains("bad_input/" + name + ":" + std::to_string(expected.wrong_line) + ": "));
    for (const auto& part : expected.says)
      CHECK_THAT(outcome.err, Contains(part));
    CHECK(outcome.peak_memory < most_memory);
  }
  CHECK_FALSE(fs::exists(tour.folder / "caught"));
  CHECK_FALSE(fs::exists("/tmp/cdem_written_outside.txt"));
}

TEST_CASE("a check finds the same mistakes without solving") {
  const Tour tour;
  for (const std::string name :
       {"typo_in_key", "zero_residual", "unknown_field", "picture_of_unknown_field", "picture_without_png",
        "setting_out_of_range", "unknown_setting", "index_nil"}) {
    const fs::path script = tour.folder / "bad_input" / (name + ".lua");
    const Expectation expected = expectation_of(script);
    std::vector<std::string> arguments = {"check", "bad_input/" + name + ".lua"};
    arguments.insert(arguments.end(), expected.arguments.begin(), expected.arguments.end());
    const Outcome outcome = tour.run(arguments);
    INFO(name << " says: " << outcome.err);
    CHECK(outcome.exit_code == expected.exit_code);
    check_one_clear_line(outcome);
    for (const auto& part : expected.says)
      CHECK_THAT(outcome.err, Contains(part));
  }
  CHECK_FALSE(fs::exists(tour.folder / "results"));
}

TEST_CASE("a solution that fails leaves its last good state on disk") {
  const Tour tour;
  const Outcome outcome = tour.run({"run", "bad_input/run_away.lua"});
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 3);
  const fs::path results = tour.folder / "results/bad_input-run_away";
  CHECK(fs::file_size(results / "last_good.vtu") > 1000);
  CHECK_THAT(read_file(results / "cdem.log"), Contains("run-away") && Contains("ended with exit code 3"));
  const Outcome info = tour.run({"info", (results / "last_good.vtu").string()});
  CHECK(info.exit_code == 0);
  CHECK_THAT(info.out, Contains("displacement") && !Contains("nan"));
}

TEST_CASE("Ctrl-C and SIGTERM end an endless loop at once") {
  const TempFolder folder;
  write_file(folder / "case.lua", "print('begins')\nwhile true do end\n");
  for (const auto& [signal, code, word] :
       {std::tuple(SIGINT, 130, "Ctrl-C"), std::tuple(SIGTERM, 143, "SIGTERM")}) {
    Start start;
    start.folder = folder.path();
    start.signal = signal;
    start.signal_after = "begins";
    const Outcome outcome = run_cdem({"run", "case.lua", "--output", word}, start);
    CHECK(outcome.exit_code == code);
    CHECK(outcome.after_signal < 2);
    check_one_clear_line(outcome);
    CHECK_THAT(outcome.err, Contains(word));
    CHECK_THAT(read_file(folder / word / "cdem.log"),
               Contains("ended with exit code " + std::to_string(code)));
  }
}

TEST_CASE("a script cannot keep an interrupt from ending it") {
  const TempFolder folder;
  write_file(folder / "case.lua",
             "print('begins')\nwhile true do pcall(function() while true do end end) end\n");
  Start start;
  start.folder = folder.path();
  start.signal = SIGINT;
  start.signal_after = "begins";
  start.limit = 20;
  const Outcome outcome = run_cdem({"run", "case.lua"}, start);
  CHECK(outcome.exit_code == 130);
  CHECK(outcome.after_signal < 2);
}

TEST_CASE("a second Ctrl-C ends a program that does not listen to the first") {
  const TempFolder folder;
  // Lua looks for interrupts between its instructions, and this is one that takes ages.
  write_file(folder / "case.lua", "print('begins');\n(('a'):rep(100000)):find(('.-'):rep(20) .. 'b')\n");
  Start start;
  start.folder = folder.path();
  start.terminal = true;
  start.keys = {{"begins", "\x03"}, {"^C", "\x03", 1.0}};
  start.limit = 20;
  const Outcome outcome = run_cdem({"run", "case.lua"}, start);
  CHECK_FALSE(outcome.timed_out);
  CHECK(outcome.exit_code == 130);
  CHECK_THAT(outcome.out, Contains("cdem: error: stopped at once by a second signal"));
}

TEST_CASE("files that are no scripts are refused") {
  const TempFolder folder;
  Start start;
  start.folder = folder.path();
  write_file(folder / "binary.lua",
             std::string("\x1bLua\x54\x00\x19\x93\r\n\x1a\n", 12) + std::string(400, '\xff'));
  write_file(folder / "picture.lua", std::string("\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR", 16));
  write_file(folder / "empty.lua", "");
  fs::create_directory(folder / "folder.lua");
  const auto run = [&](const std::string& name) {
    const Outcome outcome = run_cdem({"run", name}, start);
    INFO(name << " says: " << outcome.err);
    if (outcome.exit_code != 0)
      check_one_clear_line(outcome);
    return outcome;
  };
  // Here rather than in bad_input/, where linters would trip over it.
  write_file(folder / "unfinished.lua", "local cdem = require 'cdem'\ncdem.elastic{ density = 2500\n");
  CHECK(run("unfinished.lua").exit_code == 2);
  CHECK_THAT(run("unfinished.lua").err, Contains("unfinished.lua:3: '}' expected (to close '{' at line 2)"));
  CHECK(run("binary.lua").exit_code == 2);
  CHECK(run("picture.lua").exit_code == 2);
  CHECK(run("folder.lua").exit_code == 2);
  CHECK_THAT(run("folder.lua").err, Contains("is a folder"));
  const Outcome missing = run("emty.lua");
  CHECK(missing.exit_code == 4);
  CHECK_THAT(missing.err, Contains("emty.lua: no such file; did you mean empty.lua?"));
  CHECK(run("empty.lua").exit_code == 0); // nothing asked, nothing done
}

TEST_CASE("output that cannot be written ends with exit code 4") {
  const TempFolder folder;
  Start start;
  start.folder = folder.path();
  write_file(folder / "case.lua", "print('hello')\n");
  write_file(folder / "file", "no folder");
  write_file(folder / "mine/thesis.txt", "years of work");
  for (const std::string output : {"file", "file/below", "mine", ".", "/proc/cdem"}) {
    const Outcome outcome = run_cdem({"run", "case.lua", "--output", output}, start);
    INFO(output << ": " << outcome.err);
    CHECK(outcome.exit_code == 4);
    check_one_clear_line(outcome);
    CHECK_THAT(outcome.err, Contains("output folder"));
  }
  CHECK(read_file(folder / "mine/thesis.txt") == "years of work");
}

TEST_CASE("folders, named pipes and devices are refused wherever a file is wanted") {
  const TempFolder folder;
  REQUIRE(mkfifo((folder / "pipe.lua").c_str(), 0600) == 0);
  for (const std::string ending : {"csv", "msh", "stl", "json", "cdem", "step", "dxf"})
    REQUIRE(mkfifo((folder / ("pipe." + ending)).c_str(), 0600) == 0);
  fs::create_directory(folder / "folder.csv");
  Start start;
  start.folder = folder.path();
  start.limit = 20;
  const auto said = [&](const std::vector<std::string>& arguments) {
    const Outcome outcome = run_cdem(arguments, start);
    INFO(outcome.err);
    CHECK_FALSE(outcome.timed_out);
    CHECK((outcome.exit_code == 2 || outcome.exit_code == 4));
    CHECK(lines_of(outcome.err).size() == 1);
    return outcome.err;
  };
  CHECK_THAT(said({"run", "pipe.lua"}), Contains("is a named pipe, not a file"));
  CHECK_THAT(said({"check", "/dev/zero"}), Contains("is a device, not a file"));
  for (const std::string call :
       {"read_csv('pipe.csv')", "record{ file = 'pipe.csv', value = 'a', unit = 'g' }",
        "read_discs('pipe.csv')", "read_mesh{ file = 'pipe.msh' }", "solid.read{ file = 'pipe.stl' }",
        "solid.read{ file = 'pipe.step' }", "read_surface{ file = 'pipe.dxf' }",
        "read_pile{ file = 'pipe.json' }", "read_csv('folder.csv')"}) {
    INFO(call);
    write_file(folder / "case.lua", "require('cdem')." + call);
    CHECK_THAT(said({"check", "case.lua"}),
               Contains(call.find("folder") == std::string::npos ? "is a named pipe" : "is a folder"));
  }
  // The checkpoint of a run, its log.
  write_file(
      folder / "case.lua",
      "local cdem = require 'cdem'\n"
      "local m = cdem.model{ bodies = { { shape = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }, "
      "material = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2000 } } } }\n"
      "m:run{ steps = 10 }\nerror 'stops here'\n");
  REQUIRE(run_cdem({"run", "case.lua", "--output", "out"}, start).exit_code == 2);
  for (const char* name : {"out/checkpoint_1.cdem", "out/checkpoint_2.cdem"}) {
    fs::remove(folder / name);
    REQUIRE(mkfifo((folder / name).c_str(), 0600) == 0);
  }
  CHECK_THAT(said({"resume", "out"}), Contains("is a named pipe"));
  fs::remove(folder / "out/cdem.log");
  REQUIRE(mkfifo((folder / "out/cdem.log").c_str(), 0600) == 0);
  CHECK_THAT(said({"resume", "out"}), Contains("is not the output folder of a run"));
  CHECK_THAT(said({"info", "out"}), !Contains("internal"));
}
