// Manual pages and completion name what the program takes, and the shells take them.
#include "tests/apps/support/child.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <regex>

using namespace testing;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

struct ShellFiles {
  ShellFiles() { REQUIRE(run_cdem({"--shell-files", folder.path().string()}, {}).exit_code == 0); }
  TempFolder folder;
  std::string read(const std::string& file) const { return read_file(folder / file); }
};

// "run", "check", ...: the first words of the lines under "commands:" of --help.
std::vector<std::string> commands() {
  std::vector<std::string> names;
  bool inside = false;
  for (const std::string& line : lines_of(run_cdem({"--help"}, {}).out)) {
    if (inside && line.empty())
      break;
    if (inside)
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
    inside = inside || line == "commands:";
  }
  return names;
}

// "--output", "-o", ... of a command's help.
std::vector<std::string> options_of(const std::string& command) {
  std::vector<std::string> names;
  const std::regex option("^ +(-[a-z], )?(--[a-z-]+)");
  for (const std::string& line : lines_of(run_cdem({"help", command}, {}).out))
    if (std::smatch found; std::regex_search(line, found, option))
      names.push_back(found[2]);
  return names;
}

std::string without_backslashes(std::string text) {
  text.erase(std::remove(text.begin(), text.end(), '\\'), text.end());
  return text;
}

// What bash would offer for the last word.
std::vector<std::string> offered(const ShellFiles& files, const std::string& words) {
  const std::string script =
      "cd '" + std::string(CDEM_SOURCE) + "/examples/toppling' && source '" +
      (files.folder / "bash-completion/completions/cdem").string() + "' && COMP_WORDS=(" + words +
      ") && COMP_CWORD=$((${#COMP_WORDS[@]} - 1)) && { _cdem; true; } && printf '%s\\n' \"${COMPREPLY[@]}\"";
  const Outcome ended = run_program({"/bin/bash", "--norc", "-c", script}, {});
  REQUIRE(ended.exit_code == 0);
  return lines_of(ended.out);
}

bool installed(const char* tool) {
  return std::system(("command -v " + std::string(tool) + " >/dev/null 2>&1").c_str()) == 0;
}

} // namespace

TEST_CASE("every command and option stands in its manual page and in both completions") {
  const ShellFiles files;
  const std::string bash = files.read("bash-completion/completions/cdem"),
                    zsh = files.read("zsh/site-functions/_cdem"),
                    top = without_backslashes(files.read("man/man1/cdem.1"));
  REQUIRE(commands().size() >= 9);
  for (const std::string& command : commands()) {
    INFO(command);
    CHECK_THAT(top, Contains("cdem-" + command + " (1)"));
    const std::string page = without_backslashes(files.read("man/man1/cdem-" + command + ".1"));
    for (const std::string& option : options_of(command)) {
      INFO(option);
      CHECK_THAT(page, Contains(option));
      CHECK_THAT(bash, Contains(option));
      CHECK_THAT(zsh, Contains(option));
    }
  }
}

TEST_CASE("bash completes commands, options, scripts and folders") {
  const ShellFiles files;
  CHECK(offered(files, "cdem sw") == std::vector<std::string>{"sweep"});
  CHECK(offered(files, "cdem run --thr") == std::vector<std::string>{"--threads"});
  CHECK(offered(files, "cdem run case.lua --check") == std::vector<std::string>{"--checkpoint-every"});
  CHECK(offered(files, "cdem run ca") == std::vector<std::string>{"case.lua"});
  CHECK(offered(files, "cdem run RE") == std::vector<std::string>{""}); // README.md is no script
  CHECK(offered(files, "cdem run case.lua --output pic") == std::vector<std::string>{"pictures"});
  CHECK(offered(files, "cdem help inf") == std::vector<std::string>{"info"});
}

TEST_CASE("zsh and man take the files") {
  const ShellFiles files;
  if (installed("zsh"))
    CHECK(run_program(
              {"/bin/sh", "-c", "zsh -n '" + (files.folder / "zsh/site-functions/_cdem").string() + "'"}, {})
              .exit_code == 0);
  else
    WARN("no zsh here: its completion is not tried");
  if (!installed("groff")) {
    WARN("no groff here: the manual pages are not typeset");
    return;
  }
  for (const auto& page : fs::directory_iterator(files.folder / "man/man1")) {
    const Outcome set = run_program(
        {"/bin/sh", "-c", "groff -man -Tutf8 -ww '" + page.path().string() + "' 2>&1 >/dev/null"}, {});
    INFO(page.path());
    CHECK(set.exit_code == 0);
    CHECK(set.out.empty());
  }
}
