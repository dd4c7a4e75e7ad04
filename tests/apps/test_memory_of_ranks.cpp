// What each of several processes holds of a model that they solve together: its share, and what it writes for all.
#include "tests/apps/support/child.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <fstream>
#include <future>
#include <limits>
#include <thread>

#include <unistd.h>

using namespace testing;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

// A cube of tetrahedra with springs on all faces, of which none breaks, for as long as it is let.
const char* const cube = R"(local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400 }
local joint = cdem.mohr_coulomb{ cohesion = 1e8, friction_angle = 35, tensile_strength = 1e8 }
local model = cdem.model{ bodies = { { shape = cdem.box_mesh{ size = {1, 1, 1}, divisions = {22, 22, 22} },
  material = rock, joint = joint, name = "cube", bonds = "springs" } } }
model:fix{ on = "z-" }
model:gravity{ vector = {0, 0, -9.81} }
model:run{ steps = 100000000 }
)";

struct Process {
  pid_t number = 0;
  double anonymous = 0; // bytes in memory that no file holds
};

// Those of this program that run in the folder.
std::vector<Process> processes_in(const fs::path& folder) {
  std::vector<Process> found;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator("/proc", none)) {
    const std::string name = entry.path().filename().string();
    if (!std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c) != 0; }) ||
        fs::read_symlink(entry.path() / "cwd", none) != folder ||
        fs::read_symlink(entry.path() / "exe", none) != fs::path(CDEM_PROGRAM))
      continue;
    std::ifstream status(entry.path() / "status");
    Process process{std::stoi(name), 0};
    for (std::string word; status >> word;)
      if (double kilobytes = 0; word == "RssAnon:" && status >> kilobytes)
        process.anonymous = 1024 * kilobytes;
    found.push_back(process);
  }
  return found;
}

// Bytes, of the rank that holds most, between two looks at the whole state.
double memory_between_steps(const std::string& ranks) {
  TempFolder folder;
  write_file(folder / "case.lua", cube);
  Start start;
  start.folder = folder.path();
  start.limit = 250;
  auto running = std::async(std::launch::async, [&] {
    return run_cdem({"run", "case.lua", "--output", "out", "--threads", "1", "--ranks", ranks}, start);
  });
  const auto log_has = [&](const char* text) {
    return read_file(folder / "out/cdem.log").find(text) != std::string::npos;
  };
  const auto begun = std::chrono::steady_clock::now();
  const auto waited = [&] { return std::chrono::steady_clock::now() - begun; };
  while (!log_has("run: step ") && waited() < std::chrono::seconds(120))
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  double least = std::numeric_limits<double>::infinity();
  for (int look = 0; look < 100; ++look) {
    double most = 0;
    for (const Process& process : processes_in(folder.path()))
      most = std::max(most, process.anonymous);
    if (most > 0)
      least = std::min(least, most);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  for (const Process& process : processes_in(folder.path()))
    kill(process.number, SIGKILL);
  running.wait();
  return least;
}

// The checkpoint of a run that an error of its callback has ended at step 300: of step 200, where the stage can be left.
std::string checkpoint(const fs::path& folder, const std::string& ranks) {
  Start start;
  start.folder = folder;
  start.limit = 250;
  const Outcome outcome =
      run_cdem({"run", "case.lua", "--output", "out", "--threads", "1", "--ranks", ranks}, start);
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == 2);
  std::string content;
  for (const auto& entry : fs::directory_iterator(folder / "out"))
    if (entry.path().filename().string().rfind("checkpoint_", 0) == 0)
      content = read_file(entry.path());
  return content;
}

} // namespace

TEST_CASE("ranks: the memory of each falls with their number", "[busy]") {
  if (no_mpirun())
    return;
  const double one = memory_between_steps("1"), two = memory_between_steps("2"),
               four = memory_between_steps("4");
  INFO(one << " " << two << " " << four);
  CHECK(two < 0.8 * one);
  CHECK(four < 0.85 * two);
}

TEST_CASE("ranks: a checkpoint of three has the bytes of that of one") {
  if (no_mpirun())
    return;
  TempFolder folder;
  write_file(folder / "case.lua", R"(local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 6e5, friction_angle = 30, tensile_strength = 2e5 }
local model = cdem.model{ bodies = { { shape = cdem.box_mesh{ size = {1, 1, 1}, divisions = {8, 8, 8} }, material = rock,
  joint = joint, name = "cube", bonds = "springs" } } }
model:fix{ on = "y-" }
model:traction{ on = "y+", stress = {2e5, 2.5e5, 0} }
model:run{ steps = 100 }
model:run{ steps = 400, every = 300, callback = function() error "enough" end }
)");
  const std::string one = checkpoint(folder.path(), "1"), three = checkpoint(folder.path(), "3");
  REQUIRE(one.size() > 1000000);
  REQUIRE(three.size() == one.size());
  std::size_t differ = 0;
  for (std::size_t i = 0; i < one.size(); ++i)
    differ += one[i] != three[i] ? 1 : 0;
  CHECK(differ <= 64); // number of the run, times on the clock, checksum
}
