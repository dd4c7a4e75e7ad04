// Where a disk is full, a folder gone or without permission: one line that says so and exit code 4, never success.
#include "tests/apps/support/child.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
namespace fs = std::filesystem;

namespace {

Outcome in_shell(const std::string& command, const TempFolder& folder) {
  Start start;
  start.folder = folder.path();
  start.environment = {std::string("CDEM=") + CDEM_PROGRAM};
  return run_program({"/bin/sh", "-c", command}, start);
}

void says_why(const Outcome& outcome, const std::string& reason) {
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == 4);
  REQUIRE_FALSE(lines_of(outcome.err).empty());
  CHECK_THAT(lines_of(outcome.err).back(), StartsWith("cdem: error: ") && Contains(reason));
}

} // namespace

TEST_CASE("a file that grows above the limit of the shell fails as on a full disk") {
  const TempFolder folder;
  write_file(folder / "case.lua", "local f = io.open('big.txt', 'w')\n"
                                  "assert(f:write(('x'):rep(1 << 20)))\nassert(f:close())");
  const Outcome script = in_shell("ulimit -f 64; exec $CDEM run case.lua", folder);
  CHECK(script.exit_code == 2); // what the script asserts
  CHECK_THAT(script.err, Contains("File too large"));
  write_file(folder / "plain/case.lua", "local list = {}\nfor i = 1, 100000 do list[i] = i end\n"
                                        "require('cdem').write_csv{ file = 'big.csv', columns = {\n"
                                        "  { name = 'a', values = list } } }");
  says_why(in_shell("ulimit -f 64; exec $CDEM run plain/case.lua", folder), "big.csv");
}

TEST_CASE("a run whose output folder was deleted or moved does not end well") {
  const TempFolder folder;
  write_file(folder / "case.lua",
             "print 'begins'\nlocal till = os.time() + 2\nwhile os.time() < till do end");
  for (const std::string what : {"rm -r out", "mv out away", "rm out/cdem.log"}) {
    INFO(what);
    const Outcome outcome = in_shell("rm -rf out said; $CDEM run case.lua --output out > said & while ! grep "
                                     "-qs begins said; do :; done; " +
                                         what + "; wait $!",
                                     folder);
    says_why(outcome, "out");
  }
}

TEST_CASE("what cannot be printed is a failure, a reader that has seen enough is none") {
  const TempFolder folder;
  write_file(folder / "case.lua", "print 'one'\nprint 'two'");
  for (const std::string command :
       {"info", "--help", "--version", "run case.lua --output a", "check case.lua"}) {
    INFO(command);
    says_why(in_shell("$CDEM " + command + " > /dev/full", folder), "standard output cannot be written");
    CHECK(in_shell("$CDEM " + command + " >&-", folder).exit_code == 0);
  }
  CHECK(in_shell("{ $CDEM run case.lua --output b; echo $? > code; } | head -c 1", folder).exit_code == 0);
  CHECK(read_file(folder / "code") == "0\n");
  CHECK_THAT(read_file(folder / "b/cdem.log"), Contains("two"));
}
