// Several processes that solve one model, as a user meets them: the same report as of one, and a script that asks what
// differs between processes.
#include "tests/apps/support/plate_of_ranks.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <regex>

using namespace testing;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

TEST_CASE("ranks: the report is that of one process, told once", "[busy]") {
  if (no_mpirun())
    return;
  for (const char* const ranks : {"2", "3"}) {
    PlateFolder place;
    const Outcome outcome = place.cdem({"run", "plate/case.lua", "--output", "out", "--ranks", ranks});
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK(lines_of(outcome.err).size() == 1); // the warning of a relaxation cut short
    CHECK(place.report() == report_of_one());
    CHECK_THAT(place.log(),
               Contains(std::string(ranks) + " ranks of ") && Contains("ended with exit code 0"));
    const auto lines = lines_of(outcome.out);
    CHECK(std::count(lines.begin(), lines.end(), "begins") == 1);
    CHECK(process_of_rank(place.folder.path(), 1) == 0);
  }
}

TEST_CASE("ranks: those of a plain mpirun are the same") {
  if (no_mpirun())
    return;
  PlateFolder place;
  place.start.environment = {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"};
  const Outcome outcome = run_program({"/usr/bin/env", "mpirun", "-n", "2", "--oversubscribe", CDEM_PROGRAM,
                                       "run", "plate/case.lua", "--output", "out"},
                                      place.start);
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK(place.report() == report_of_one());
}

// One model of each kind: blocks of small strain that break and are cut, a cohesive mesh, an armour unit that a flow
// breaks, a pile that settles and is pushed by a flow, Voronoi blocks that come loose, a body that shatters.
const std::string& physics() {
  static const std::string text = read_file(CDEM_SOURCE "/tests/apps/ranks/physics.lua");
  return text;
}

std::vector<std::string> solve_physics(int ranks, int threads) {
  return {"run",       "plate/case.lua",        "--output", "out",
          "--threads", std::to_string(threads), "--ranks",  std::to_string(ranks)};
}

const std::string& physics_of_one() {
  static const std::string report = [] {
    PlateFolder place(physics());
    REQUIRE(place.cdem(solve_physics(1, 1)).exit_code == 0);
    const std::string of_one = place.report();
    CHECK(std::count(of_one.begin(), of_one.end(), '{') > 12);
    return of_one;
  }();
  return report;
}

TEST_CASE("ranks: every kind of model ends in the bits of one process", "[busy]") {
  if (no_mpirun())
    return;
  for (const auto& [ranks, threads] : {std::pair(1, 2), std::pair(2, 2), std::pair(3, 1), std::pair(8, 1)}) {
    PlateFolder place(physics());
    place.start.limit = 250;
    const Outcome outcome = place.cdem(solve_physics(ranks, threads));
    INFO(ranks << " ranks of " << threads << " threads: " << outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK(place.report() == physics_of_one());
  }
}

TEST_CASE("ranks: a slab goes to pieces on a rigid floor with the bits of one process", "[busy]") {
  if (no_mpirun())
    return;
  const auto report_on = [](const char* ranks) {
    PlateFolder place(read_file(CDEM_SOURCE "/tests/apps/ranks/slab.lua"));
    const Outcome outcome = place.cdem({"run", "plate/case.lua", "--output", "out", "--ranks", ranks});
    INFO(ranks << " ranks: " << outcome.out << outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return place.report();
  };
  const std::string of_one = report_on("1");
  CHECK(report_on("2") == of_one);
  CHECK(report_on("3") == of_one);
}

// Names and values of a report. What is warned of at the end of a script may differ after cdem resume: models that were done
// with before are not looked at again.
std::string figures_of(const std::string& report) {
  std::string figures;
  for (const std::string& line : lines_of(report))
    if (line.find("\"name\": ") != std::string::npos || line.find("\"value\": ") != std::string::npos)
      figures += line + '\n';
  return figures;
}

TEST_CASE("ranks: every kind of model, left in each of its stages, goes on with the same bits on other ranks",
          "[busy]") {
  if (no_mpirun())
    return;
  PlateFolder place(physics());
  place.start.limit = 250;
  const std::vector<std::string> stages = {"plate", "beam", "unit", "settle", "flow", "collapse", "shatter"};
  const std::vector<std::pair<int, int>> counts = {{2, 1}, {1, 2}, {3, 1}, {2, 1},
                                                   {4, 1}, {1, 1}, {2, 2}, {1, 1}};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto& [ranks, threads] = counts[i];
    std::vector<std::string> words = solve_physics(ranks, threads);
    if (i == 0)
      words.insert(words.end(), {"--set", "stops=1"});
    else
      words = {"resume", "out", "--threads", std::to_string(threads), "--ranks", std::to_string(ranks)};
    const bool last = i == stages.size();
    const Outcome outcome = place.cdem(words, last ? 0 : SIGTERM, last ? "" : "half of " + stages[i]);
    INFO(ranks << " ranks of " << threads << " threads: " << outcome.out << outcome.err);
    REQUIRE(outcome.exit_code == (last ? 0 : 128 + SIGTERM));
    if (i > 0)
      CHECK_THAT(outcome.out, Contains("goes on from "));
  }
  CHECK(figures_of(place.report()) == figures_of(physics_of_one()));
}

// A column that a floor breaks from below, in several chunks.
TEST_CASE("ranks: chunks change hands where a body breaks on one side, and no bit does", "[busy]") {
  if (no_mpirun())
    return;
  const std::string text = R"(local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500, stiffness_damping = 1e-6 }
local weak = cdem.mohr_coulomb{ cohesion = 3e5, friction_angle = 35, tensile_strength = 1e5 }
local rough = cdem.coulomb{ friction_angle = 30 }
local column = cdem.solid.box{ size = {0.2, 0.2, 2}, origin = {0, 0, 1e-3} }:mesh{ size = 0.04 }
local model = cdem.model{ bodies = {
  { shape = cdem.solid.box{ size = {2, 2, 0.2}, origin = {-1, -1, -0.2} }:mesh{ size = 1 }, material = rock,
    element = "rigid", name = "floor" },
  { shape = column, material = rock, joint = weak, name = "column", bonded_faces = "all", bonds = "springs" } },
  contacts = { default = rough } }
model:fix{ on = "floor" }
model:initial_velocity{ on = "column", velocity = {0, 0, -8} }
model:run{ steps = 410 }
cdem.report{ { name = "hash", value = model.state_hash }, { name = "breaks", value = #model:breaks() } }
)";
  std::string of_one;
  for (const int ranks : {1, 3}) {
    PlateFolder place(text);
    place.start.limit = 250;
    const Outcome outcome = place.cdem(solve_physics(ranks, 1));
    INFO(outcome.out << outcome.err);
    REQUIRE(outcome.exit_code == 0);
    if (ranks == 1)
      of_one = place.report();
    CHECK(place.report() == of_one);
    if (ranks > 1)
      CHECK_THAT(place.log(), Contains("chunks shared anew: "));
  }
}

TEST_CASE("ranks: more of them than chunks solve a model too, and say so") {
  if (no_mpirun())
    return;
  const std::string text = R"(local cdem = require "cdem"
local model = cdem.model{ bodies = { { shape = cdem.box_mesh{ size = {1, 1, 1}, divisions = {2, 2, 2} },
  material = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 } } } }
model:fix{ on = "y-" }
model:gravity{ vector = {0, -9.81, 0} }
model:run{ steps = 20 }
model:run{ steps = 20 }
cdem.report{ { name = "hash", value = model.state_hash } }
)";
  PlateFolder one(text), three(text);
  REQUIRE(one.cdem(solve_physics(1, 1)).exit_code == 0);
  const Outcome outcome = three.cdem(solve_physics(3, 1));
  CHECK(outcome.exit_code == 0);
  CHECK(three.report() == one.report());
  CHECK(lines_of(outcome.err).size() == 1);
  CHECK_THAT(outcome.err, Contains("1 chunk for 3 ranks: 2 of them have no elements to compute"));
}

TEST_CASE("ranks: only rank 0 needs to see the script and the output folder, and all must run one program") {
  if (no_mpirun())
    return;
  PlateFolder place;
  place.start.environment = {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"};
  const fs::path elsewhere = place.folder / "elsewhere";
  fs::create_directories(elsewhere);
  const auto both = [&](const std::string& program, const std::string& folder) {
    return run_program({"/usr/bin/env",
                        "mpirun",
                        "-q",
                        "--oversubscribe",
                        "-n",
                        "1",
                        CDEM_PROGRAM,
                        "run",
                        "plate/case.lua",
                        "--output",
                        "out",
                        ":",
                        "-n",
                        "1",
                        "--wdir",
                        folder,
                        program,
                        "run",
                        "plate/case.lua",
                        "--output",
                        "out"},
                       place.start);
  };
  const Outcome solved = both(CDEM_PROGRAM, elsewhere.string());
  INFO(solved.out << solved.err);
  CHECK(solved.exit_code == 0);
  CHECK(place.report() == report_of_one());
  CHECK(fs::is_empty(elsewhere));
  // A program that differs in its last byte.
  const fs::path other = elsewhere / "cdem";
  fs::copy_file(CDEM_PROGRAM, other);
  fs::copy_file(fs::path(CDEM_PROGRAM).parent_path() / "cdem_mpi.so", elsewhere / "cdem_mpi.so");
  std::ofstream(other, std::ios::app) << ' ';
  const Outcome refused = both(other.string(), place.folder.path().string());
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, Contains("cdem: error: rank 1: the program differs from that of rank 0"));
}

TEST_CASE("ranks: a module of another build is refused in one line") {
  if (no_mpirun())
    return;
  PlateFolder place;
  const TempFolder elsewhere;
  fs::copy_file(CDEM_PROGRAM, elsewhere / "cdem");
  std::string module = read_file(fs::path(CDEM_PROGRAM).parent_path() / "cdem_mpi.so");
  std::smatch checksum; // of the declaration with which it was compiled
  REQUIRE(std::regex_search(module, checksum, std::regex("[0-9a-f]{64}")));
  module.replace(static_cast<std::size_t>(checksum.position()), 64, std::string(64, '0'));
  write_file(elsewhere / "cdem_mpi.so", module);
  const Outcome outcome =
      run_program({(elsewhere / "cdem").string(), "run", "plate/case.lua", "--output", "out", "--ranks", "2"},
                  place.start);
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("cdem_mpi.so is of another build than this program"));
  CHECK(lines_of(outcome.err).size() == 1);
}

TEST_CASE("ranks: the clock, chance and files are asked once for all, and go on alike") {
  if (no_mpirun())
    return;
  PlateFolder place(R"lua(local cdem = require "cdem"
math.randomseed()
local file = assert(io.open("notes.txt", "w"))
assert(file:write(os.time(), " ", os.clock(), " ", math.random(), " ", os.date(), " ", cdem.elapsed(), "\n"))
file:write("second line\n")
local at = file:seek("cur")
file:close()
local text, lines = "", 0
for line in io.lines("notes.txt") do text, lines = text .. line, lines + 1 end
local added = assert(io.open("notes.txt", "a+"))
added:write("third")
added:close()
local all = assert(io.open("notes.txt")):read("a")
local none, why = io.open("no/such.txt")
print(none, why)
-- Ranks that had seen other values would come to the stage with other arguments, and be told so.
local rock = cdem.elastic{ youngs_modulus = 1e9 + #all + at + tonumber(text:match("^%d+ ([%d.]+)")), poissons_ratio = 0,
  density = 2000 + math.random() }
local box = cdem.solid.box{ size = {1, 1, 1} }:mesh{ size = 0.5 } -- in a child process of rank 0
local model = cdem.model{ bodies = { { shape = box, material = rock } } }
model:fix{ on = "y-" }
model:gravity{ vector = {0, -9.81, 0} }
model:run{ steps = 100 + lines * 10 + math.random(50) + #all + at + math.floor(os.clock() * 1e6) % 50 }
model:save{ file = "end.vtu" }
model:picture{ file = "end.png" }
cdem.report{ { name = "hash", value = model.state_hash } }
print(all)
)lua");
  const Outcome outcome = place.cdem({"run", "plate/case.lua", "--output", "out", "--ranks", "2"});
  INFO(outcome.out << outcome.err);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(read_file(place.folder / "out/notes.txt"), Contains("second line\nthird"));
  CHECK(fs::exists(place.folder / "out/end.vtu"));
  CHECK(fs::exists(place.folder / "out/end.png"));
}

TEST_CASE("ranks: what rank 0 cannot tell the others is refused in one line") {
  if (no_mpirun())
    return;
  for (const auto& [text, said] :
       {std::pair("print(io.read())", "io.read: not with several ranks"),
        std::pair("assert(io.open('/dev/urandom', 'rb'))", "/dev/urandom: a device may never end")}) {
    PlateFolder place(text);
    const Outcome outcome =
        place.cdem({"run", "plate/case.lua", "--output", "out", "--ranks", "2", "--unsafe"});
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK(lines_of(outcome.err).size() == 1);
    CHECK_THAT(outcome.err, Contains(said));
  }
}

TEST_CASE("ranks: a script that goes another way in one process is told so") {
  if (no_mpirun())
    return;
  // Addresses are not the same in two processes; these two lines differ in what they are called with.
  PlateFolder place(
      "local cdem = require 'cdem'\n"
      "local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0, density = 2000 }\n"
      "local model = cdem.model{ bodies = { { shape = cdem.grid{ size = {1, 1, 1}, divisions = {1, 1, 1} },\n"
      "  material = rock } } }\n"
      "model:fix{ on = 'y-' }\n"
      "model:run{ steps = tonumber(tostring({}):match('0x(%x+)'), 16) % 100003 + 1 }\n");
  const Outcome outcome = place.cdem({"run", "plate/case.lua", "--output", "out", "--ranks", "2"});
  CHECK(outcome.exit_code == 2);
  CHECK_THAT(outcome.err, Contains("rank 1: what run is called with, stage 1, differs from that of rank 0"));
}

TEST_CASE("ranks: what does not solve one model is refused or done once") {
  if (no_mpirun())
    return;
  PlateFolder place;
  place.start.environment = {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"};
  const auto ranks = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"/usr/bin/env", "mpirun", "-q", "-n", "2", "--oversubscribe", CDEM_PROGRAM});
    return run_program(words, place.start);
  };
  const Outcome version = ranks({"--version"});
  CHECK(lines_of(version.out).size() == 1);
  const Outcome sweep = ranks({"sweep", "plate/case.lua", "--set", "steps=1,2"});
  CHECK(sweep.exit_code == 2);
  CHECK_THAT(sweep.err, Contains("cdem sweep: this is one of 2 ranks"));
  CHECK_THAT(ranks({"run", "plate/case.lua", "--ranks", "2"}).err, Contains("leave --ranks out"));
  const Outcome two = ranks(
      {"run", "plate/case.lua", ":", "-n", "1", CDEM_PROGRAM, "run", "plate/case.lua", "--set", "steps=3"});
  CHECK(two.exit_code == 2);
  CHECK_THAT(two.err, Contains("cdem: error: rank 2: the command line differs from that of rank 0"));
  const Outcome check = ranks({"check", "plate/case.lua"});
  CHECK(check.exit_code == 0);
  CHECK_THAT(check.out, Contains("no errors found"));
}
