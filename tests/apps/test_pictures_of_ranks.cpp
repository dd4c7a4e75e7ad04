// Pictures and files that a script makes while several processes solve a model: the bytes of one process, and no whole
// state is sent for a picture.
#include "tests/apps/support/case_folder.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <regex>

using namespace testing;
namespace fs = std::filesystem;

namespace {

// A block of tetrahedra that shatters on a rigid floor, and Voronoi blocks of small strain that are pulled apart.
const char* const falls = R"lua(local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }
local weak = cdem.mohr_coulomb{ cohesion = 3e5, friction_angle = 35, tensile_strength = 1e5 }
local fall = cdem.model{ bodies = {
    { shape = cdem.solid.box{ size = {3, 3, 0.3}, origin = {-1, -1, -0.302} }:mesh{ size = 1 }, material = rock,
      element = "rigid", name = "floor" },
    { shape = cdem.box_mesh{ size = {1, 1, 1}, divisions = {5, 5, 5}, jitter = 0.1 },
      material = rock, joint = weak, name = "block", bonds = "springs" } },
  contacts = { default = cdem.coulomb{ friction_angle = 30 } } }
fall:fix{ on = "floor" }
fall:initial_velocity{ on = "block", velocity = {0, 0, -8} }
local function look(model, name, colours)
  local frame = 0
  return function()
    frame = frame + 1
    model:save{ file = name .. frame .. ".vtu" } -- rank 0 alone sees the whole
    model:picture{ file = name .. frame .. "_section.png", colour = "von_mises", size = {320, 240},
                   section = { point = {0.4, 0.3, 0.4}, normal = {1, 0.2, 0} } }
    for _, colour in ipairs(colours) do
      model:picture{ file = name .. frame .. "_" .. colour .. ".png", colour = colour, deformation = 2, size = {320, 240} }
    end
    model:picture{ file = name .. frame .. "_plain.png", size = {320, 240}, hidden = name == "fall" and {"floor"} or nil,
                   crosses = true, arrows = true }
    model:save{ file = name .. frame .. "_after.vtu" } -- all see the whole, for the damage
  end
end
fall:run{ steps = 240, every = 120, callback = look(fall, "fall", { "displacement.magnitude", "velocity.z", "stress.zz",
                                                                    "von_mises", "damage", "block_id" }) }
local pull = cdem.model{ bodies = { { shape = cdem.voronoi{ size = {1.2, 0.8, 0.8}, count = 40, seed = 3 },
  material = rock, joint = weak, name = "plate", element = "small_strain" } } }
pull:fix{ on = "x-" }
pull:fix{ on = "x+", velocity = {0.5, 0, 0} }
pull:run{ steps = 240, every = 120, callback = look(pull, "pull", { "displacement.x", "principal_stress.1", "damage",
                                                                    "joint_slip" }) }
cdem.report{ { name = "hash", value = fall.state_hash }, { name = "hash too", value = pull.state_hash } }
)lua";

// Of the pictures and saved files. These tell the name of the folder of the script.
std::map<std::string, std::string> results_of(const CaseFolder& place, const std::string& ranks) {
  const std::string out = "out" + ranks;
  const Outcome outcome =
      place.cdem({"run", "case.lua", "--output", out, "--threads", "1", "--ranks", ranks});
  INFO(ranks << " ranks: " << outcome.out << outcome.err);
  REQUIRE(outcome.exit_code == 0);
  std::map<std::string, std::string> files{{"report", read_file(place.folder / out / "report.json")}};
  for (const auto& entry : fs::directory_iterator(place.folder / out))
    if (const fs::path file = entry.path(); file.extension() == ".png" || file.extension() == ".vtu")
      files[file.filename().string()] = read_file(file);
  return files;
}

} // namespace

TEST_CASE(
    "ranks: pictures and files from a callback have the bytes of one process, and change none of the model",
    "[busy]") {
  if (no_mpirun())
    return;
  CaseFolder place({{"case.lua", falls}});
  place.start.limit = 250;
  const std::map<std::string, std::string> of_one = results_of(place, "1");
  CHECK(of_one.size() > 25);
  for (const char* const ranks : {"2", "3"}) {
    const std::map<std::string, std::string> of_many = results_of(place, ranks);
    REQUIRE(of_many.size() == of_one.size());
    for (const auto& [name, bytes] : of_one) {
      INFO(ranks << " ranks: " << name);
      CHECK((of_many.at(name) == bytes));
    }
  }
}

namespace {

// MB that two ranks have sent for a cube of 20,736 tetrahedra, by the log.
double sent_with(const std::string& look) {
  CaseFolder place({{"case.lua", R"lua(local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400 }
local joint = cdem.mohr_coulomb{ cohesion = 1e8, friction_angle = 35, tensile_strength = 1e8 }
local model = cdem.model{ bodies = { { shape = cdem.box_mesh{ size = {1, 1, 1}, divisions = {12, 12, 24} },
  material = rock, joint = joint, name = "cube", bonds = "springs" } } }
model:fix{ on = "z-" }
model:gravity{ vector = {0, 0, -9.81} }
local sum = 0
model:run{ steps = 190, every = 10, callback = function() )lua" +
                                     look + R"lua( end }
)lua"}});
  place.start.limit = 250;
  const Outcome outcome =
      place.cdem({"run", "case.lua", "--output", "out", "--threads", "1", "--ranks", "2"});
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const std::string log = read_file(place.folder / "out/cdem.log");
  const std::regex told("messages of ([0-9.,e+]+) MB in all");
  double sum = 0;
  for (std::sregex_iterator at(log.begin(), log.end(), told), end; at != end; ++at) {
    std::string number = (*at)[1];
    number.erase(std::remove(number.begin(), number.end(), ','), number.end());
    sum += std::stod(number);
  }
  REQUIRE(sum > 0);
  return sum;
}

} // namespace

TEST_CASE("ranks: a callback costs what it looks at: nothing, the surface of a picture, or the whole state") {
  if (no_mpirun())
    return;
  const double nothing = sent_with("sum = sum + model.time"),
               picture =
                   sent_with("model:picture{ file = 'now.png', colour = 'stress.zz', size = {64, 64} }"),
               whole = sent_with("sum = sum + model:energy().kinetic");
  INFO("MB: " << nothing << ", " << picture << ", " << whole);
  CHECK(picture - nothing < 0.1 * (whole - nothing));
}
