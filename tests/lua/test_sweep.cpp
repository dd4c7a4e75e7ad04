#include "libcdem/step/errors.hpp"
#include "lua/binding/files/process_pool.hpp"
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>
#include <chrono>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

std::vector<Job> shell_jobs(const fs::path& folder, const std::vector<std::string>& commands) {
  std::vector<Job> jobs;
  for (const std::string& command : commands) {
    Job job;
    job.command = {"/bin/sh", "-c", command};
    job.console = folder / ("console_" + std::to_string(jobs.size()));
    jobs.push_back(job);
  }
  return jobs;
}

bool never() {
  return false;
}
void nothing(const Job&) {}

} // namespace

TEST_CASE("jobs give their exit codes and what they print", "[lua]") {
  Script place("");
  auto jobs = shell_jobs(place.folder, {"echo one; echo two >&2", "exit 3", "kill -9 $$"});
  int ended = 0;
  CHECK(run_jobs(jobs, 2, never, [&](const Job&) { ++ended; }));
  CHECK(ended == 3);
  CHECK(jobs[0].exit_code == 0);
  CHECK(jobs[1].exit_code == 3);
  CHECK(jobs[2].exit_code == 128 + 9);
  CHECK(read_file(jobs[0].console) == "one\ntwo\n");
}

TEST_CASE("no more jobs run at once than allowed", "[lua]") {
  Script place("");
  const std::string count =
      "cd " + place.folder.string() +
      " && touch running_$$ && ls | grep -c running_ >> seen && sleep 0.1 && rm running_$$";
  auto jobs = shell_jobs(place.folder, std::vector<std::string>(6, count));
  REQUIRE(run_jobs(jobs, 2, never, nothing));
  const std::string seen = read_file(place.folder / "seen");
  CHECK(seen.find_first_not_of("12\n") == std::string::npos);
}

TEST_CASE("a stop ends running jobs with SIGINT and starts no more", "[lua]") {
  Script place("");
  auto jobs = shell_jobs(place.folder, {"trap 'echo stopped; exit 130' INT; while :; do sleep 0.05; done",
                                        "sleep 60", "touch " + (place.folder / "third").string()});
  const auto start = std::chrono::steady_clock::now();
  const auto half_a_second = [&] {
    return std::chrono::steady_clock::now() - start > std::chrono::milliseconds(500);
  };
  CHECK_FALSE(run_jobs(jobs, 2, half_a_second, nothing));
  CHECK(jobs[0].exit_code == 130);
  CHECK(jobs[1].exit_code == 128 + 2);
  CHECK_FALSE(fs::exists(place.folder / "third"));
}

TEST_CASE("a program that is not there is a file error", "[lua]") {
  Script place("");
  std::vector<Job> jobs(1);
  jobs[0].command = {"/no/such/program"};
  jobs[0].console = place.folder / "console";
  CHECK_THROWS_AS(run_jobs(jobs, 1, never, nothing), FileError);
}

// The program is stood in for by a shell script that writes the report a case would write.
TEST_CASE("a sweep runs each case with its settings and returns the figures of its report", "[lua]") {
  Script script("local cdem = require 'cdem'\n"
                "local r = cdem.sweep{ script = 'one.lua', set = { { case = 1 }, { case = 2, list = {1.5, 2} "
                "}, { case = 'bad' } }, jobs = 2 }\n"
                "for i, row in ipairs(r) do\n"
                "  print(i, row.output, row.exit_code, row.figures.arguments, row.set.case)\nend");
  script.write("one.lua", "");
  script.write("program", "#!/bin/sh\n"
                          "case \"$*\" in *bad*) echo 'cdem: error: no such case' >&2; exit 2;; esac\n"
                          "arguments=\"$(basename $2) $3 $4 $5 $6\"\n"
                          "while [ \"$1\" != --output ]; do shift; done\nmkdir -p $2\n"
                          "echo '{\"case\": \"one\", \"figures\": [{\"name\": \"arguments\", \"value\": "
                          "\"'$arguments'\"}, {\"name\": \"none\", \"value\": null}]}' > $2/report.json\n");
  fs::permissions(script.folder / "program", fs::perms::owner_all);
  script.settings.program = (script.folder / "program").string();
  script.run();
  const auto& lines = script.listener->lines;
  REQUIRE(lines.size() == 7);
  CHECK(lines[4] == "1\tcase=1\t0\tone.lua --set case=1 --quiet --output\t1");
  CHECK(lines[5] == "2\tcase=2,list=1.5,2\t0\tone.lua --set case=2 --set list=1.5,2\t2");
  CHECK(lines[6] == "3\tcase=bad\t2\tnil\tbad");
  const std::string progress = lines[0] + "\n" + lines[1] + "\n" + lines[2] + "\n" + lines[3] + "\n";
  CHECK_THAT(progress, Contains("case=bad failed with exit code 2\n"));
  CHECK_THAT(progress,
             Contains("case.lua:2: warning: sweep: run 3 of 3 (case = bad) failed with exit code 2: no such "
                      "case; its figures are empty\n"));
  CHECK_THAT(progress, Contains("sweep 3/3"));
}

TEST_CASE("a sweep that cannot work is refused", "[lua]") {
  const std::string sweep_head = "local cdem = require 'cdem'\n";
  CHECK_THAT(error_of(sweep_head + "cdem.sweep{ script = 'case.lua', set = { { a = 1 } } }"),
             Contains("a script that sweeps itself would never end"));
  Script lonely(sweep_head + "cdem.sweep{ script = 'one.lua', set = { { a = 1 } } }");
  lonely.write("one.lua", "");
  CHECK_THAT(lonely.error(), Contains("only from the cdem program"));
  CHECK_THAT(error_of(sweep_head + "cdem.sweep{ script = 'case.lua', set = {} }"),
             Contains("set = {}: must be a list of at least 1 item"));
  CHECK_THROWS_AS(error_of(sweep_head + "cdem.sweep{ script = 'missing.lua', set = { { a = 1 } } }"),
                  FileError);
}
