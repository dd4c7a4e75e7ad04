#include "tests/apps/support/child.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using Catch::Matchers::Contains;

namespace {

// A home of its own: the history of whoever runs the test stays as it is.
struct Home {
  TempFolder folder;
  Start start;
  Home() {
    start.folder = folder.path();
    start.environment = {"XDG_STATE_HOME=" + (folder / "state").string()};
    start.limit = 20;
  }
  Outcome piped(const std::string& input) {
    start.terminal = false;
    start.input = input;
    return run_cdem({"repl"}, start);
  }
  // Each is typed once there is a prompt, then Ctrl-D.
  Outcome typed(const std::vector<std::string>& lines) {
    start.terminal = true;
    start.keys.clear();
    for (const auto& line : lines)
      start.keys.push_back({"> ", line});
    start.keys.push_back({"> ", "\x04"});
    return run_cdem({"repl"}, start);
  }
};

const std::string ctrl_c = "\x03", arrow_up = "\x1b[A";

} // namespace

TEST_CASE("piped lines are run and their values printed") {
  Home home;
  const Outcome outcome = home.piped("x = 20\nx + 1\n'te' .. 'xt'\n");
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("21") && Contains("text"));
  CHECK(outcome.err.empty());
}

TEST_CASE("the module is at hand, and a statement may take several lines") {
  Home home;
  const Outcome outcome = home.piped("for i = 1, 2 do\n  print('line ' .. i)\nend\n"
                                     "print(#cdem.grid{ size = {1, 1, 1},\n divisions = {2, 3, 4} })\n");
  INFO(outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("line 1") && Contains("line 2") && Contains("24"));
}

TEST_CASE("the first error of piped input ends the program") {
  Home home;
  const Outcome outcome =
      home.piped("cdem.grid{ size = {1, 1, 1}, divisions = {0, 1, 1} }\nprint('too late')\n");
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Catch::Matchers::StartsWith("cdem: error: ") && Contains("divisions[1] = 0"));
  CHECK(lines_of(outcome.err).size() == 1);
  CHECK_THAT(outcome.out, !Contains("too late"));
  CHECK(home.piped("for i = 1, 2 do\n").exit_code == 2);
}

TEST_CASE("on a terminal an error costs only its line, and Ctrl-D ends") {
  Home home;
  const Outcome outcome = home.typed({"nothing.at_all\r", "1 + 41\r"});
  CHECK_FALSE(outcome.timed_out);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("cdem: error: ") && Contains("nil value") && Contains("42\r\n"));
}

TEST_CASE("help tells about a function, with its example, and names the nearest") {
  Home home;
  const Outcome outcome = home.piped("help\nhelp model:fix\nhelp(cdem.grid)\nhelpless = 41\nhelpless + 1\n");
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("Supports, loads and changes") && Contains("model:fix{ on, ... }") &&
                              Contains("cdem.grid{ size, divisions, ... }") && Contains("42\n"));
  const Outcome wrong = home.piped("help model:fixx\n");
  CHECK(wrong.exit_code == 2);
  CHECK_THAT(wrong.err, Contains("model:fixx") && Contains("did you mean model:fix?"));
}

TEST_CASE("errors are in colour on a terminal, and not where NO_COLOR says so or nobody looks") {
  const std::string in_colour = "cdem: \033[1;31merror:\033[0m ";
  Home home;
  home.start.environment.push_back("NO_COLOR=");
  CHECK_THAT(home.typed({"nothing.at_all\r"}).out, Contains(in_colour));
  CHECK_THAT(home.piped("nothing.at_all\n").err, Contains("cdem: error: ") && !Contains("\033"));
  home.start.environment.back() = "NO_COLOR=1";
  CHECK_THAT(home.typed({"nothing.at_all\r"}).out, Contains("cdem: error: ") && !Contains(in_colour));
}

TEST_CASE("the tab key completes names of the module") {
  Home home;
  const Outcome outcome = home.typed({"cdem.mohr_c\t\r"});
  CHECK_FALSE(outcome.timed_out);
  CHECK_THAT(outcome.out, Contains("cdem.mohr_coulomb"));
}

TEST_CASE("Ctrl-C cancels the line") {
  Home home;
  // It costs an unfinished statement too: what follows starts afresh.
  const Outcome outcome = home.typed({"for i = 1, 3 do\r", "print(i)" + ctrl_c, "6 * 7\r"});
  CHECK_FALSE(outcome.timed_out);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("^C") && Contains("42\r\n"));
}

TEST_CASE("Ctrl-C stops a line that runs, and the next one is read") {
  Home home;
  home.start.terminal = true;
  home.start.keys = {{"> ", "print('beg' .. 'ins') while true do end\r"},
                     {"begins\r\n", ctrl_c},
                     {"> ", "6 * 7\r"},
                     {"42\r\n", ""},
                     {"> ", "\x04"}};
  const Outcome outcome = run_cdem({"repl"}, home.start);
  CHECK_FALSE(outcome.timed_out);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("stopped by Ctrl-C") && Contains("42\r\n"));
}

TEST_CASE("what was typed is there in the next session") {
  Home home;
  home.typed({"remembered = 'yes'\r"});
  CHECK(read_file(home.folder / "state/cdem/repl_history") == "remembered = 'yes'\n");
  const Outcome outcome = home.typed({arrow_up + "\r", "remembered\r"});
  CHECK_THAT(outcome.out, Contains("yes\r\n") || Contains("\"yes\"\r\n"));
}
