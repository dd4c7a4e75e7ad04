#include "tests/apps/support/case_folder.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <thread>

using namespace testing;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
namespace fs = std::filesystem;

namespace {

const char* const sum = R"(
local cdem = require "cdem"
local a = cdem.parameter{ name = "a", default = 1, unit = "m" }
local b = cdem.parameter{ name = "b", default = 1 }
if a == 13 then error("13 brings no luck") end
if b == 99 then while true do end end
cdem.report{ { name = "sum_m", value = a + b, unit = "m" } }
)";

struct SweepFolder : CaseFolder {
  SweepFolder() : CaseFolder({{"sum/case.lua", sum}}) {}
  std::vector<std::string> table() const {
    return lines_of(read_file(folder / "results/sum-sweep/sweep.csv"));
  }
};

} // namespace

TEST_CASE("a sweep runs every combination and gathers the figures") {
  const SweepFolder cdem;
  const Outcome outcome =
      cdem({"sweep", "sum/case.lua", "--set", "a=1,2", "--set", "b=10,20,30", "--jobs", "2"});
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const auto table = cdem.table();
  REQUIRE(table.size() == 7);
  CHECK(table[0] == "a (m),b,exit_code,wall_time (s),sum_m (m)");
  const std::vector<std::string> settings = {"1,10", "1,20", "1,30", "2,10", "2,20", "2,30"},
                                 sums = {"11", "21", "31", "12", "22", "32"};
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK_THAT(table[i + 1], StartsWith(settings[i] + ",0,"));
    CHECK(table[i + 1].substr(table[i + 1].rfind(',') + 1) == sums[i]);
  }
  CHECK(fs::exists(cdem.folder / "results/sum-sweep/a=2,b=30/report.json"));
  CHECK(read_file(cdem.folder / "results/sum-sweep/sweep_sum_m.png").rfind("\x89PNG", 0) == 0);
  CHECK_THAT(read_file(cdem.folder / "results/sum-sweep/cdem.log"), Contains("ended with exit code 0"));
}

TEST_CASE("a run of a sweep may read what an earlier run beside it wrote, wherever the folder is") {
  const SweepFolder cdem;
  write_file(cdem.folder / "study/maker.lua",
             "local cdem = require 'cdem'\n"
             "local x = cdem.parameter{ name = 'x', default = 1 }\n"
             "cdem.write_csv{ file = 'x.csv', columns = {{ name = 'x', values = {x} }} }\n"
             "cdem.report{ { name = 'x', value = x } }\n");
  write_file(cdem.folder / "study/reader.lua",
             "local cdem = require 'cdem'\n"
             "local file = cdem.parameter{ name = 'file', default = 'x.csv' }\n"
             "cdem.report{ { name = 'x', value = cdem.read_csv(file).x[1] } }\n");
  write_file(cdem.folder / "study/case.lua",
             "local cdem = require 'cdem'\n"
             "local made = cdem.sweep{ script = 'maker.lua', set = {{ x = 7 }} }[1]\n"
             "local read = cdem.sweep{ script = 'reader.lua', set = {{ file = '../' .. made.output .. "
             "'/x.csv' }} }[1]\n"
             "cdem.report{ { name = 'x', value = read.figures.x } }\n");
  const TempFolder elsewhere;
  const Outcome outcome = cdem({"run", "study/case.lua", "--output", (elsewhere / "out").string()});
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(read_file(elsewhere / "out/report.json"), Contains("\"value\": 7"));
}

TEST_CASE("a run of a sweep that fails is named, and the others go on") {
  const SweepFolder cdem;
  const Outcome outcome = cdem({"sweep", "sum/case.lua", "--set", "a=1,13,2"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.out, Contains("a=13: exit code 2") && Contains("13 brings no luck"));
  CHECK_THAT(outcome.err, Contains("cdem: error: 1 of 3 runs failed"));
  CHECK(lines_of(outcome.err).size() == 1);
  const auto table = cdem.table();
  REQUIRE(table.size() == 4);
  CHECK_THAT(table[1], StartsWith("1,0,"));
  CHECK_THAT(table[2], StartsWith("13,2,"));
  CHECK_THAT(table[3], StartsWith("2,0,"));
}

TEST_CASE("Ctrl-C ends a sweep and every run of it") {
  SweepFolder cdem;
  cdem.start.signal = SIGINT;
  cdem.start.signal_after = "a=1 b=1: done";
  const Outcome outcome = cdem({"sweep", "sum/case.lua", "--set", "a=1", "--set", "b=1,99", "--jobs", "1"});
  CHECK(outcome.exit_code == 130);
  CHECK(outcome.after_signal < 3);
  const auto table = cdem.table();
  REQUIRE(table.size() == 3);
  CHECK_THAT(table[1], StartsWith("1,1,0,"));
}

TEST_CASE("runs of a sweep end with it, even when it is killed") {
  SweepFolder cdem;
  write_file(cdem.folder / "sum/case.lua", R"(
local cdem = require "cdem"
local a = cdem.parameter{ name = "a", default = 1 }
if a == 99 then
  cdem.write_csv{ file = "begun.csv", columns = { { name = "x", values = {1} } } }
  while true do end
end
local function has_begun() -- the second run
  local found, file = pcall(io.open, "../a=99/begun.csv")
  return found and file
end
while not has_begun() do end
)");
  cdem.start.signal = SIGKILL;
  cdem.start.signal_after = "a=1: done";
  const Outcome outcome = cdem({"sweep", "sum/case.lua", "--set", "a=1,99", "--jobs", "2"});
  CHECK(outcome.exit_code == 128 + SIGKILL);
  const auto runs = [&] { // processes that work in the folder
    int count = 0;
    for (const fs::directory_entry& process : fs::directory_iterator("/proc")) {
      std::error_code none;
      if (fs::read_symlink(process.path() / "cwd", none) == fs::canonical(cdem.folder.path()))
        ++count;
    }
    return count;
  };
  bool ended = false;
  for (int i = 0; i < 100 && !ended; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ended = runs() == 0;
  }
  CHECK(ended);
}

TEST_CASE("a sweep that was stopped says what stands and what can be done, which then works") {
  SweepFolder cdem;
  write_file(cdem.folder / "sum/case.lua", R"(
local cdem = require "cdem"
local a = cdem.parameter{ name = "a", default = 1 }
while a > 2 do end
local function has_begun() -- the second run
  local found, file = pcall(io.open, "../a=2/begun.csv")
  return found and file
end
while a == 1 and not has_begun() do end
if a == 2 then
  local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0, density = 2000 }
  local model = cdem.model{ bodies = { { shape = cdem.box{ size = {1, 1, 1} }, material = rock, element = "small_strain" } } }
  model:fix{ on = "x-" }
  model:traction{ on = "x+", stress = {1e6, 0, 0} }
  local begun = false
  model:run{ steps = 3000000, callback = function()
    if not begun then cdem.write_csv{ file = "begun.csv", columns = { { name = "x", values = {1} } } } end
    begun = true
  end }
end
cdem.report{ { name = "a", value = a } }
)");
  cdem.start.signal = SIGINT;
  cdem.start.signal_after = "a=1: done";
  const Outcome outcome = cdem({"sweep", "sum/case.lua", "--set", "a=1,2,3,4", "--jobs", "2"});
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == 130);
  const auto lines = lines_of(outcome.out);
  REQUIRE(lines.size() > 3);
  CHECK(lines.end()[-3] == "1 of 4 runs had ended and stands; table in results/sum-sweep/sweep.csv");
  CHECK(lines.end()[-2] == "a=2: stopped; to go on: cdem resume results/sum-sweep/a=2");
  CHECK(
      lines.end()[-1] ==
      "2 runs have nothing to go on from: cdem sweep with their values and another --output runs them anew");
  CHECK_THAT(read_file(cdem.folder / "results/sum-sweep/cdem.log"), Contains(lines.end()[-2]));
  cdem.start.signal = 0;
  cdem.start.signal_after.clear();
  const Outcome on = cdem({"resume", "results/sum-sweep/a=2"});
  INFO(on.out << on.err);
  CHECK(on.exit_code == 0);
  CHECK_THAT(read_file(cdem.folder / "results/sum-sweep/a=2/report.json"), Contains("\"value\": 2"));
}

TEST_CASE("a script can sweep another one") {
  const SweepFolder cdem;
  write_file(cdem.folder / "sum/all.lua", R"(
local cdem = require "cdem"
local runs = cdem.sweep{ script = "case.lua", set = { { a = 1 }, { a = 5 } }, jobs = 2 }
for _, run in ipairs(runs) do print("a gives " .. run.figures.sum_m) end
)");
  for (int again = 0; again < 2; ++again) {
    const Outcome outcome = cdem({"run", "sum/all.lua"});
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Contains("a gives 2") && Contains("a gives 6"));
  }
}

TEST_CASE("a run that fails in a script's sweep is a warning, counted and in the report") {
  const SweepFolder cdem;
  write_file(cdem.folder / "sum/all.lua", R"(
local cdem = require "cdem"
local runs = cdem.sweep{ script = "case.lua", set = { { a = 1 }, { a = 13, b = 2 } } }
cdem.report{ { name = "sum", value = runs[1].figures.sum_m } }
)");
  const Outcome outcome = cdem({"run", "sum/all.lua"});
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == 0);
  const std::string warning =
      "sweep: run 2 of 2 (a = 13, b = 2) failed with exit code 2: sum/case.lua:5: 13 brings no "
      "luck; its figures are empty";
  CHECK_THAT(outcome.err, StartsWith("sum/all.lua:3: warning: " + warning + "\n"));
  CHECK_THAT(outcome.out, Contains("1 warning; results in results/sum-all"));
  for (const std::string file : {"report.json", "report.md", "cdem.log"})
    CHECK_THAT(read_file(cdem.folder / "results/sum-all" / file), Contains(warning));
  CHECK_THAT(
      cdem({"check", "sum/all.lua"}).err,
      Contains("warning: sweep: run 2 of 2 (a = 13, b = 2) failed with exit code 2; cdem check sum/case.lua "
               "--set a=13 --set b=2 tells why"));
}

TEST_CASE("a check of a script that sweeps has no figures, whatever an earlier run has left") {
  const SweepFolder cdem;
  write_file(cdem.folder / "sum/all.lua", R"(
local cdem = require "cdem"
local runs = cdem.sweep{ script = "case.lua", set = { { a = 1 }, { a = 5 } }, jobs = 2 }
for _, run in ipairs(runs) do print("a gives " .. tostring(run.figures.sum_m)) end
)");
  REQUIRE_THAT(cdem({"run", "sum/all.lua"}).out, Contains("a gives 6"));
  const Outcome outcome = cdem({"check", "sum/all.lua"});
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Contains("a gives nil") && !Contains("a gives 2") && !Contains("a gives 6"));
  CHECK_THAT(outcome.out, Contains("sweep 2/2: a=") && Contains(" checked in ") && !Contains("done"));
}

TEST_CASE("a script that was stopped in a sweep goes on with the runs that had not ended") {
  SweepFolder cdem;
  const std::string swept = R"(
local cdem = require "cdem"
local a = cdem.parameter{ name = "a", default = 1 }
while a == 2 and not io.open("sum/go") and not io.open("go") do end
cdem.report{ { name = "ten_times", value = 10 * a } }
)";
  write_file(cdem.folder / "sum/swept.lua", swept);
  write_file(cdem.folder / "sum/all.lua", R"(
local cdem = require "cdem"
local first = cdem.sweep{ script = "case.lua", set = { { a = 1 } } }[1]
local sum = first.figures.sum_m
for _, run in ipairs(cdem.sweep{ script = "swept.lua", set = { { a = 1 }, { a = 2 }, { a = 3 } }, jobs = 1 }) do
  sum = sum + run.figures.ten_times
end
cdem.report{ { name = "sum", value = sum } }
)");
  cdem.start.signal = SIGINT;
  cdem.start.signal_after = "sweep 1/3: a=1 done";
  const Outcome stopped = cdem({"run", "sum/all.lua", "--unsafe"});
  CHECK(stopped.exit_code == 130);
  CHECK_THAT(stopped.out + stopped.err, Contains("to go on: cdem resume results/sum-all --unsafe"));
  const auto log_of = [&](const std::string& run) {
    return read_file(cdem.folder / "results/sum-all" / run / "cdem.log");
  };
  const std::string first = log_of("a=1");

  write_file(cdem.folder / "sum/swept.lua", "error('of another sweep')");
  write_file(cdem.folder / "sum/go", "");
  cdem.start.signal = 0;
  cdem.start.signal_after.clear();
  const Outcome on = cdem({"resume", "results/sum-all", "--unsafe"});
  INFO(on.out << on.err);
  REQUIRE(on.exit_code == 0);
  CHECK_THAT(on.out + on.err, Contains("1 of 3 runs had ended"));
  CHECK(log_of("a=1") == first);
  CHECK_THAT(log_of("a=3"), Contains("ended with exit code 0"));
  CHECK_THAT(read_file(cdem.folder / "results/sum-all/report.json"), Contains("\"value\": 62"));
  CHECK_FALSE(fs::exists(cdem.folder / "results/sum-all/checkpoint_1.cdem"));

  // What stands there from an earlier run is not taken for its own.
  write_file(cdem.folder / "sum/swept.lua", swept);
  CHECK(cdem({"run", "sum/all.lua", "--unsafe"}).exit_code == 0);
  CHECK(log_of("a=1") != first);
}

TEST_CASE("a script that fails behind a sweep is mended and goes on") {
  const SweepFolder cdem;
  const std::string all = R"(
local cdem = require "cdem"
local run = cdem.sweep{ script = "case.lua", set = { { a = 1 } } }[1]
cdem.report{ { name = "sum", value = run.figures.sum_m, WRONG } }
)";
  const auto write = [&](const std::string& word) {
    std::string text = all;
    write_file(cdem.folder / "sum/all.lua", text.replace(text.find("WRONG"), 5, word));
  };
  write("unti = 'm'");
  const Outcome failed = cdem({"run", "sum/all.lua"});
  CHECK(failed.exit_code == 2);
  CHECK_THAT(failed.out + failed.err, Contains("go on with cdem resume results/sum-all"));
  const fs::path log = cdem.folder / "results/sum-all/a=1/cdem.log";
  const std::string first = read_file(log);
  write("unit = 'm'");
  CHECK(cdem({"resume", "results/sum-all"}).exit_code == 0);
  CHECK(read_file(log) == first);
  CHECK_THAT(read_file(cdem.folder / "results/sum-all/report.json"), Contains("\"value\": 2"));
}

// The first of the runs waits until everything has been edited.
TEST_CASE("a sweep runs what stood there when it began, and names the user's own files in errors") {
  const auto helper = [](int b) {
    return "local helper = { b = " + std::to_string(b) +
           " }\nfunction helper.fail() error('no luck') end\nreturn helper\n";
  };
  const std::string text = R"(
local cdem = require "cdem"
local helper, deep = require "helper", require("folder.deep")
local a = cdem.parameter{ name = "a", default = 1 }
while not io.open("sum/go") and not io.open("go") do end
if a == 3 then helper.fail() end
cdem.report{ { name = "sum_m", value = a + helper.b + deep + cdem.read_csv("x.csv").x[1], unit = "m" } }
)";
  const std::string all = R"(
local cdem = require "cdem"
local runs = cdem.sweep{ script = "case.lua", set = { { a = 1 }, { a = 2 }, { a = 3 } }, jobs = 1 }
for _, run in ipairs(runs) do print(run.set.a .. " gives " .. (run.figures.sum_m or "nothing")) end
)";
  for (const bool by_script : {false, true})
    for (const bool unsafe : {false, true}) {
      INFO((by_script ? "cdem.sweep" : "cdem sweep") << (unsafe ? ", unsafe" : ""));
      const SweepFolder cdem;
      write_file(cdem.folder / "sum/case.lua", text);
      write_file(cdem.folder / "sum/all.lua", all);
      write_file(cdem.folder / "sum/helper.lua", helper(10));
      write_file(cdem.folder / "sum/folder/deep.lua", "return 100");
      write_file(cdem.folder / "sum/x.csv", "x\n1000\n");
      std::vector<std::string> command =
          by_script ? std::vector<std::string>{"run", "sum/all.lua"}
                    : std::vector<std::string>{"sweep", "sum/case.lua", "--set", "a=1,2,3", "--jobs", "1"};
      if (unsafe)
        command.push_back("--unsafe");
      const fs::path results = cdem.folder / (by_script ? "results/sum-all" : "results/sum-sweep");
      std::thread editor([&] {
        for (int i = 0; i < 1000 && !fs::exists(results / "a=1/cdem.log"); ++i)
          std::this_thread::sleep_for(std::chrono::milliseconds(10));
        write_file(cdem.folder / "sum/case.lua", "error('the new script')");
        write_file(cdem.folder / "sum/helper.lua", helper(5));
        fs::remove(cdem.folder / "sum/folder/deep.lua");
        write_file(cdem.folder / "sum/go", "");
      });
      const Outcome outcome = cdem(command);
      editor.join();
      INFO(outcome.out << outcome.err);
      CHECK_THAT(outcome.out + outcome.err, Contains("sum/helper.lua:2: no luck"));
      for (const std::string a : {"1", "2"})
        CHECK_THAT(read_file(results / ("a=" + a) / "report.json"),
                   Contains(std::to_string(std::stoi(a) + 1110)));
      CHECK(read_file(results / "a=2/case.lua") == text);
      CHECK(read_file(results / "swept/case.lua") == text);
      CHECK(fs::exists(results / "swept/folder/deep.lua"));
    }
}

TEST_CASE("sweep --slurm: a job array of one run a task, whose rest the same command writes anew") {
  const SweepFolder cdem;
  // An srun that runs what it is given here.
  write_file(cdem.folder / "bin/srun",
             "#!/bin/sh\nwhile [ \"${1#--}\" != \"$1\" ]; do shift; done\nexec \"$@\"\n");
  fs::permissions(cdem.folder / "bin/srun", fs::perms::owner_all);
  const std::vector<std::string> command = {"sweep", "sum/case.lua", "--set", "a=1,2,13", "--set",
                                            "b=10",  "--threads",    "1",     "--slurm"};
  const fs::path batch = cdem.folder / "results/sum-sweep/sweep.sbatch";
  const auto task = [&](int number) {
    Start start = cdem.start;
    start.environment = {"SLURM_ARRAY_TASK_ID=" + std::to_string(number),
                         "PATH=" + (cdem.folder / "bin").string() + ":/usr/bin:/bin"};
    return run_program({"/bin/sh", batch.string()}, start);
  };
  const Outcome written = cdem(command);
  INFO(written.out << written.err);
  REQUIRE(written.exit_code == 0);
  CHECK_THAT(written.out, Contains("3 runs; to run them: sbatch results/sum-sweep/sweep.sbatch"));
  CHECK_THAT(read_file(batch), Contains("#SBATCH --array=1-3\n") && Contains("#SBATCH --signal=TERM@300\n"));
  CHECK_FALSE(fs::exists(cdem.folder / "results/sum-sweep/sweep.csv"));
  // Each runs the text of when the array was written.
  write_file(cdem.folder / "sum/case.lua", "error 'edited'");
  CHECK(task(2).exit_code == 0);
  CHECK(task(3).exit_code == 2);
  CHECK_THAT(cdem(command).err, Contains("swept/case.lua is of another text of case.lua"));
  write_file(cdem.folder / "sum/case.lua", sum);
  CHECK_THAT(cdem(command).out,
             Contains("3 runs, 1 of which have ended") && Contains("to run the rest: sbatch"));
  CHECK_THAT(read_file(batch), Contains("#SBATCH --array=1,3\n"));
  REQUIRE(cdem.table().size() == 4);
  CHECK(cdem.table()[2] == "2,10,0,,12");
  CHECK(cdem.table()[1] == "1,10,,,");
  CHECK(task(1).exit_code == 0);
  CHECK_THAT(task(1).out, Contains("a=1 b=10: had ended and stands"));
  CHECK_THAT(cdem({"sweep", "sum/case.lua", "--set", "a=1", "--point", "2"}).err,
             Contains("the sweep has 1 run"));
  CHECK_THAT(cdem({"sweep", "sum/case.lua", "--set", "a=1", "--ranks", "2"}).err,
             Contains("--ranks goes with --slurm"));
}

TEST_CASE("sweep --slurm: a task that was stopped goes on from its checkpoint") {
  const SweepFolder cdem;
  write_file(cdem.folder / "sum/case.lua", R"(local cdem = require "cdem"
local steps = cdem.parameter{ name = "steps", default = 1 }
local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2000 }
local model = cdem.model{ bodies = { { shape = cdem.grid{ size = {1, 1, 1}, divisions = {1, 1, 1} },
  material = rock } } }
model:fix{ on = "x-" }
print "begins"
model:run{ steps = steps }
cdem.report{ { name = "steps", value = steps } }
)");
  const std::vector<std::string> point = {"sweep", "sum/case.lua", "--set", "steps=3000000", "--point", "1"};
  REQUIRE(cdem({"sweep", "sum/case.lua", "--set", "steps=3000000", "--slurm"}).exit_code == 0);
  Start start = cdem.start;
  start.signal = SIGTERM;
  start.signal_after = "begins";
  CHECK(run_cdem(point, start).exit_code == 143);
  start.signal_after = "goes on from";
  const Outcome again = run_cdem(point, start);
  INFO(again.out << again.err);
  CHECK_THAT(again.out, Contains("goes on from"));
}
