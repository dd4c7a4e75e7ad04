// A run is kept wherever the user stops it.
#include "tests/lua/stopped_script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script::test;

TEST_CASE("resume: whatever is stopped after something was solved goes on, in functions given to calls too",
          "[checkpoint]") {
  // Faces chosen by a function that takes long, which calls ask between stages, in callbacks and as stages begin;
  // stages too short to be looked at on their way; a change of the model; a film.
  const std::string text = R"(
local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 6e5, friction_angle = 30, tensile_strength = 2e5 }
local model = cdem.model{ bodies = { { shape = cdem.grid{ size = {1, 1, 0.5}, divisions = {2, 2, 1} },
  material = rock, joint = joint, name = "plate" } } }
local function at(place)
  return function(_, y)
    for _ = 1, 300 do end
    return math.abs(y - place) < 1e-6
  end
end
model:select{ name = "top", on = at(1) }
model:fix{ on = at(0) }
model:traction{ on = "top", stress = {0, 1e5, 0} }
model:film{ file = "plate.ogv", steps = 40, size = {64, 64}, fit = { min = {0, 0, 0}, max = {1, 1, 1} } }
local seen = {}
for i = 1, 3 do
  model:run{ steps = 25, every = 10, callback = function() seen[#seen + 1] = model:reaction("top")[2] end }
  seen[#seen + 1] = model:mean("displacement.y", "top")
end
for i = 1, 6 do model:run{ steps = 7 } end
model:remove{ on = cdem.select.where(function(x) for _ = 1, 5000 do end return x > 0.5 end) }
seen[#seen + 1] = model:counts().blocks
model:gravity{ vector = {0, -1, 0} }
model:relax{ max_steps = 40 }
seen[#seen + 1] = model:mean("displacement.y", at(0))
cdem.report{ { name = "hash", value = model.state_hash }, { name = "seen", value = table.concat(seen, " ") } }
)";
  StoppedScript whole(text);
  const int looks = whole.count_looks();
  const std::string report = whole.text("report.json"), history = whole.read("history.csv");
  int kept = 0, lost_after = 0;
  for (int look = 1; look <= looks; ++look) {
    StoppedScript broken(text);
    if (broken.ends_before(look))
      continue;
    INFO("stopped at look " << look << " of " << looks);
    if (!broken.wrote("checkpoint_1.cdem")) {
      lost_after = look;
      CHECK(kept == 0); // none was solved yet
      continue;
    }
    ++kept;
    CHECK(broken.wrote("plate.ogv"));
    broken.go_on_from_newest();
    // Stopped again before its first step.
    int again = 0;
    broken.listener->stop = [&] { return ++again >= 1; };
    CHECK_THROWS_AS(broken.run(), cdem::Interrupted);
    broken.listener->stop = nullptr;
    broken.go_on_from_newest();
    broken.run();
    CHECK(broken.text("report.json") == report);
    CHECK(broken.read("history.csv") == history);
    CHECK(broken.read("plate.ogv").size() ==
          whole.read("plate.ogv").size()); // the file has a number of its own
  }
  CHECK(kept > looks / 2);
  CHECK(lost_after < looks / 2);
}

TEST_CASE("resume: a search for the factor of safety and a growing crack go on from any stop",
          "[checkpoint]") {
  const std::string text = R"(
local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 3e5, friction_angle = 30, tensile_strength = 1e5 }
local function pulled(stress)
  local model = cdem.model{ bodies = { { shape = cdem.grid{ size = {1, 1, 0.25}, divisions = {2, 2, 1} },
    material = rock, joint = joint, name = "plate" } } }
  model:fix{ on = function(_, y) for _ = 1, 200 do end return y < 1e-6 end }
  model:traction{ on = "y+", stress = {0, stress, 0} }
  return model
end
local model = pulled(5e4)
local found = cdem.factor_of_safety{ model = model, reduce = {"joints"}, lower = 1, upper = 4, tolerance = 1,
  residual = 1e-3, max_steps = 2000 }
local other = pulled(1.1e5)
other:relax{ breaking = false, residual = 1e-3 }
local grown = other:grow{ passes = 1, residual = 1e-2, max_steps = 500, max_rounds = 2 }
cdem.report{ { name = "factor", value = found.factor }, { name = "hash", value = found.stable.state_hash },
  { name = "grown", value = grown.state }, { name = "other", value = other.state_hash } }
)";
  StoppedScript whole(text);
  const int looks = whole.count_looks();
  bool begun = false;
  for (int look = 1; look <= looks; look += 1 + looks / 60) {
    StoppedScript broken(text);
    if (broken.ends_before(look))
      continue;
    INFO("stopped at look " << look << " of " << looks);
    CHECK((broken.wrote("checkpoint_1.cdem") || !begun));
    begun = broken.wrote("checkpoint_1.cdem");
    if (!begun)
      continue;
    broken.go_on_from_newest();
    broken.run();
    CHECK(broken.text("report.json") == whole.text("report.json"));
  }
  CHECK(begun);
}
