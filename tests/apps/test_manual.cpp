// What the documents say is what the program prints.
#include "tests/apps/support/child.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using Catch::Matchers::Contains;

namespace {

std::string document(const std::string& name) {
  return read_file(std::string(CDEM_SOURCE) + "/docs/" + name);
}

} // namespace

TEST_CASE("docs/command-line.md is what the program prints (anew: cdem --manual > docs/command-line.md)") {
  const std::string printed = run_cdem({"--manual"}, {}).out;
  CHECK(document("command-line.md") == printed);
  const std::string help = run_cdem({"help", "run"}, {}).out;
  CHECK_THAT(printed, Contains(help));
}

TEST_CASE("docs/exit-codes.md has every exit code of --help, with its meaning") {
  const std::string codes = document("exit-codes.md");
  std::size_t rows = 0;
  bool in_table = false;
  for (const auto& line : lines_of(run_cdem({"--help"}, {}).out)) {
    if (in_table) {
      const auto code = line.substr(2, line.find(' ', 2) - 2);
      const auto meaning = line.substr(line.find_first_not_of(' ', 2 + code.size()));
      // The table there marks programs as code and may say more behind the meaning.
      std::string marked = meaning;
      if (const std::string name = "./cdem"; marked.compare(0, name.size(), name) == 0)
        marked = "`" + name + "`" + marked.substr(name.size());
      CHECK_THAT(codes, Contains("| " + code + " | " + marked));
      ++rows;
    }
    in_table = in_table || line == "exit codes:";
  }
  CHECK(rows == 9);
}
