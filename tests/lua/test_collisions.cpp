// Blocks that meet in free flight.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;

TEST_CASE("cubes that meet at any angle without friction part with the energy they had", "[lua][contact]") {
  // At 1e8 Pa/m, crossings that end as deep as they are take 0.014 to 0.042 of it.
  const int seed = GENERATE(7, 11, 23);
  const double stiffness = GENERATE(1e8, 1e9); // Pa/m
  CAPTURE(seed, stiffness);
  const auto warnings =
      warnings_of("local seed, stiffness = " + std::to_string(seed) + ", " + std::to_string(stiffness) + R"(
local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 1e10, poissons_ratio = 0.2, density = 2500 }
local law = cdem.coulomb{ friction_angle = 0, normal_stiffness = stiffness, shear_stiffness = stiffness }
local function random() seed = (seed * 1103515245 + 12345) % 2147483648 return seed / 2147483648 end
local function turned(x, y, a) return x * math.cos(a) - y * math.sin(a), x * math.sin(a) + y * math.cos(a) end
local function cube(cx, cy, cz)
  local a, b, c = 6.28 * random(), 6.28 * random(), 6.28 * random()
  local points = {}
  for i = 0, 7 do
    local x, y, z = 0.5 * (i % 2) - 0.25, 0.5 * (i // 2 % 2) - 0.25, 0.5 * (i // 4) - 0.25
    x, y = turned(x, y, a)
    y, z = turned(y, z, b)
    x, z = turned(x, z, c)
    points[i + 1] = { cx + x, cy + y, cz + z }
  end
  return cdem.convex_hull{ points = points }
end
local bodies, spins = {}, {}
for i = 1, 40 do
  local x, y = 3 * (i % 8), 3 * math.floor(i / 8)
  for _, side in ipairs{ "low", "high" } do
    local beside = side == "low" and 0 or 0.3
    local shape = cube(x + beside * (random() - 0.5), y + beside * (random() - 0.5), 3 * beside)
    bodies[#bodies + 1] = { name = side .. i, shape = shape, material = rock, element = "rigid", joint = law }
    spins[side .. i] = { 6 * (random() - 0.5), 6 * (random() - 0.5), 6 * (random() - 0.5) }
  end
end
local model = cdem.model{ bodies = bodies, contacts = { default = law } }
for i = 1, 40 do
  model:initial_velocity{ on = "low" .. i, velocity = { 0, 0, 1 }, angular_velocity = spins["low" .. i] }
  model:initial_velocity{ on = "high" .. i, velocity = { 0, 0, -1 }, angular_velocity = spins["high" .. i] }
end
local before = model:energy().kinetic
model:run{ duration = 1.6, safety = 0.5 }
local now = model:energy()
local function at_most(value, most, of) assert(math.abs(value) <= most, of .. " " .. value) end
at_most(now.kinetic / before - 1, 3e-3, "kinetic energy")
at_most(now.friction / before, 2e-3, "friction")
at_most(now.balance_error, 1e-3, "balance")
assert(#model:breaks() == 0)
)");
  CHECK(warnings.empty());
}
