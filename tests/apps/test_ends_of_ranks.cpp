// How several processes that solve one model end: one message for an error or a stop, and nothing left behind when one is
// killed.
#include "tests/apps/support/plate_of_ranks.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <future>
#include <thread>

#include <sys/resource.h>

using namespace testing;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

TEST_CASE("ranks: an error of the script is told once, with its exit code") {
  if (no_mpirun())
    return;
  const std::vector<std::array<std::string, 3>> cases = {
      {"local cdem = require 'cdem'\ncdem.elastic{ youngs_modulus = -1, poissons_ratio = 0, density = 1 }",
       "2", "youngs_modulus = -1: must be"},
      {"local cdem = require 'cdem'\ncdem.read_csv 'none.csv'", "4",
       "cdem.read_csv: file \"none.csv\": not found"}};
  for (const auto& [text, code, said] : cases) {
    PlateFolder place(text);
    const Outcome outcome = place.cdem({"run", "plate/case.lua", "--output", "out", "--ranks", "2"});
    CHECK(outcome.exit_code == std::stoi(code));
    CHECK(lines_of(outcome.err).size() == 1);
    CHECK_THAT(outcome.err, Contains("cdem: error: plate/case.lua:2: ") && Contains(said));
  }
  PlateFolder place;
  CHECK_THAT(place.cdem({"run", "none.lua", "--ranks", "2"}).err, Contains("none.lua: no such file"));
  CHECK_THAT(place.cdem({"run", "plate/case.lua", "--ranks", "0"}).err, Contains("--ranks = 0: must be"));
  CHECK_THAT(place.cdem({"run", "plate/case.lua", "--ranks", "2", "--set", "stepps=3"}).err,
             Contains("did you mean"));
}

TEST_CASE("ranks: an output folder that goes while they run ends all with one message") {
  if (no_mpirun())
    return;
  PlateFolder place("print 'begins'\nlocal till = os.time() + 2\nwhile os.time() < till do end");
  auto running = std::async(std::launch::async, [&] {
    return place.cdem({"run", "plate/case.lua", "--output", "out", "--ranks", "2"});
  });
  const auto begun = std::chrono::steady_clock::now();
  while (place.log().find("begins") == std::string::npos &&
         std::chrono::steady_clock::now() - begun < std::chrono::seconds(20))
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  fs::remove_all(place.folder / "out");
  const Outcome outcome = running.get();
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == 4);
  CHECK(lines_of(outcome.err).size() == 1);
  CHECK_THAT(outcome.err, Contains("cdem: error: ") && Contains("out"));
}

namespace {

// Addresses are not the same in two processes: a script tells by one whether it runs on rank 0.
const char* const on_rank_0 = R"(local cdem = require "cdem"
local own = {}
local file = io.open("address.txt", "w")
file:write(tostring(own))
file:close()
local on_rank_0 = io.open("address.txt"):read("a") == tostring(own)
)";

const char* const steps = R"(
local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }
local model = cdem.model{ bodies = { { shape = cdem.box_mesh{ size = {1, 1, 1}, divisions = {8, 8, 8} },
  material = rock, name = "cube" } } }
model:fix{ on = "y-" }
model:gravity{ vector = {0, -9.81, 0} }
local looks = 0
local function fails() %s end
local function solve()
  model:run{ steps = 1000000, every = 50, callback = function()
    looks = looks + 1
    if looks ~= 5 then return end
    print "fails now"
    fails()
  end }
end
print "begins"
%s
print "goes on"
)";

// How a run of two or three ranks ends in which one of them fails.
void require_end_of_all(const std::string& fails, const std::string& solves, int code,
                        const std::string& said, const char* ranks) {
  std::string text = steps;
  text.replace(text.find("%s"), 2, fails);
  text.replace(text.find("%s"), 2, solves);
  PlateFolder place(on_rank_0 + text);
  // The signal does nothing: it tells when the rank fails.
  const Outcome outcome = place.cdem({"run", "plate/case.lua", "--output", "out", "--ranks", ranks,
                                      "--threads", "1", "--checkpoint-every", "0.0001"},
                                     SIGCONT, "fails now");
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == code);
  CHECK(lines_of(outcome.err).size() == 1);
  CHECK_THAT(outcome.err, Contains(said));
  CHECK_THAT(outcome.out, !Contains("goes on"));
  CHECK(outcome.after_signal < 10);
  CHECK(process_of_rank(place.folder.path(), 1) == 0);
  CHECK(fs::exists(place.folder / "out/checkpoint_1.cdem"));
}

} // namespace

TEST_CASE("ranks: an error on one rank alone, in a step, ends all with its message and exit code") {
  if (no_mpirun())
    return;
  const std::string caught = "pcall(solve)"; // no script can go on without the others
  require_end_of_all("if not on_rank_0 then error('here alone') end", "solve()", 2,
                     "cdem: error: rank 1: plate/case.lua:", "2");
  require_end_of_all("if on_rank_0 then error('here alone') end", caught, 2, "here alone", "3");
  require_end_of_all("if not on_rank_0 then model:max('no.field') end", caught, 2, "no.field", "2");
  // What is solved inside is not the same either.
  require_end_of_all(
      "if on_rank_0 then cdem.elastic{ youngs_modulus = -1, poissons_ratio = 0, density = 1 } end", "solve()",
      2, "youngs_modulus = -1", "2");
}

TEST_CASE("ranks: models that are not the same on all of them end all with one message") {
  if (no_mpirun())
    return;
  PlateFolder place(std::string(on_rank_0) + R"(
cdem.model{ bodies = { { shape = cdem.box_mesh{ size = {on_rank_0 and 1 or 2, 1, 1}, divisions = {2, 2, 2} },
  material = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 } } } })");
  const Outcome outcome = place.cdem({"run", "plate/case.lua", "--output", "out", "--ranks", "2"});
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == 2);
  CHECK(lines_of(outcome.err).size() == 1);
  CHECK_THAT(outcome.err, Contains("rank 1 has built another model than rank 0"));
}

TEST_CASE("ranks: a callback that looks at the model on one rank alone ends all with one message") {
  if (no_mpirun())
    return;
  std::string text = steps;
  text.replace(text.find("%s"), 2, "if not on_rank_0 then model:max('velocity.x') end");
  text.replace(text.find("%s"), 2, "solve()");
  PlateFolder place(on_rank_0 + text);
  const Outcome outcome =
      place.cdem({"run", "plate/case.lua", "--output", "out", "--ranks", "2", "--threads", "1"});
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == 2);
  CHECK(lines_of(outcome.err).size() == 1);
  CHECK_THAT(outcome.err,
             Contains("a callback goes another way on rank 1, which looks at the state where rank 0 "
                      "ended its callback"));
}

TEST_CASE("ranks: one rank that runs out of memory ends all") {
  if (no_mpirun())
    return;
  PlateFolder place(std::string(on_rank_0) + R"(
print "begins"
local blocks = {}
for i = 1, 1000 do blocks[i] = cdem.grid{ size = {1, 1, 1}, divisions = {40, 40, 40} } end
)");
  auto running = std::async(std::launch::async, [&] {
    return place.cdem({"run", "plate/case.lua", "--output", "out", "--ranks", "2", "--threads", "1"});
  });
  const auto begun = std::chrono::steady_clock::now();
  while (place.log().find("begins") == std::string::npos &&
         std::chrono::steady_clock::now() - begun < std::chrono::seconds(20))
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const pid_t process = process_of_rank(place.folder.path(), 1);
  REQUIRE(process > 0);
  const rlimit little{rlim_t{1} << 20, RLIM_INFINITY};
  REQUIRE(prlimit(process, RLIMIT_AS, &little, nullptr) == 0);
  const auto limited = std::chrono::steady_clock::now();
  const Outcome outcome = running.get();
  INFO(outcome.out << outcome.err);
  CHECK(std::chrono::steady_clock::now() - limited < std::chrono::seconds(10));
  CHECK(outcome.exit_code == 2);
  CHECK(lines_of(outcome.err).size() == 1);
  CHECK_THAT(outcome.err, Contains("rank 1") && Contains("memory"));
}

TEST_CASE("ranks: Ctrl-C and SIGTERM keep a checkpoint, from which another number of ranks goes on") {
  if (no_mpirun())
    return;
  for (const auto& [signal, ranks, again] :
       {std::array<int, 3>{SIGINT, 2, 3}, std::array<int, 3>{SIGTERM, 3, 1}}) {
    PlateFolder place;
    const Outcome stopped = place.cdem(
        {"run", "plate/case.lua", "--output", "out", "--ranks", std::to_string(ranks)}, signal, "begins");
    INFO(stopped.out << stopped.err);
    CHECK(stopped.exit_code == 128 + signal);
    CHECK(stopped.err ==
          (signal == SIGINT ? "cdem: error: stopped by Ctrl-C\n" : "cdem: error: stopped by SIGTERM\n"));
    CHECK_THAT(stopped.out, Contains("checkpoint; to go on: cdem resume out\n"));
    const Outcome ended = place.cdem({"resume", "out", "--ranks", std::to_string(again)});
    INFO(ended.out << ended.err);
    CHECK(ended.exit_code == 0);
    CHECK_THAT(ended.out, Contains("goes on from "));
    CHECK(place.report() == report_of_one());
  }
}

TEST_CASE("ranks: Ctrl-C ends what never comes back") {
  if (no_mpirun())
    return;
  for (const std::string text : {"print 'begins'\nstring.find(('a'):rep(40000), ('.-'):rep(20) .. 'b')\n",
                                 "print 'begins'\nwhile true do end"}) {
    PlateFolder place(text);
    const Outcome outcome =
        place.cdem({"run", "plate/case.lua", "--output", "out", "--ranks", "2"}, SIGINT, "begins");
    CHECK(outcome.exit_code == 130);
    CHECK_THAT(outcome.err, Contains("cdem: error: stopped by Ctrl-C"));
    CHECK(lines_of(outcome.err).size() == 1);
    CHECK(outcome.after_signal < 6);
  }
}

TEST_CASE("ranks: when one is killed all end within ten seconds, and a checkpoint is kept") {
  if (no_mpirun())
    return;
  for (const int rank : {1, 0}) {
    PlateFolder place;
    auto running = std::async(std::launch::async, [&] {
      return place.cdem({"run", "plate/case.lua", "--output", "out", "--ranks", "2", "--set",
                         "steps=100000000", "--checkpoint-every", "0.002"});
    });
    const fs::path checkpoint = place.folder / "out/checkpoint_2.cdem";
    const auto begun = std::chrono::steady_clock::now();
    while (!fs::exists(checkpoint) && std::chrono::steady_clock::now() - begun < std::chrono::seconds(40))
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const pid_t process = process_of_rank(place.folder.path(), rank);
    REQUIRE(process > 0);
    const auto killed = std::chrono::steady_clock::now();
    kill(process, SIGKILL);
    const Outcome outcome = running.get();
    INFO(outcome.out << outcome.err);
    CHECK(std::chrono::steady_clock::now() - killed < std::chrono::seconds(10));
    CHECK(outcome.exit_code == 6);
    CHECK_THAT(outcome.err, Contains("cdem: error: a rank was killed"));
    const auto lines = lines_of(outcome.err);
    CHECK(std::count_if(lines.begin(), lines.end(), [](const std::string& line) {
            return line.find("error: ") != std::string::npos;
          }) == 1);
    for (const int other : {0, 1})
      CHECK(process_of_rank(place.folder.path(), other) == 0);
    // It goes on from there, to the next Ctrl-C.
    const Outcome again = place.cdem({"resume", "out"}, SIGINT, "goes on");
    CHECK(again.exit_code == 130);
    CHECK_THAT(again.out, Contains("goes on from out/checkpoint_"));
  }
}
