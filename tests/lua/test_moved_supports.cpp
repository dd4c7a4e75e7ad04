// Relaxations that move supports: what breaks on their way.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;

TEST_CASE("of two joints of a cantilever only the weaker breaks, however far its end is led at once",
          "[lua][relax]") {
  const double margin = GENERATE(1.1, 1.3), way = GENERATE(1.05, 1.5, 5.0);
  CAPTURE(margin, way);
  // The stress at the root is one and a half times that in the middle.
  const auto warnings =
      warnings_of("local margin, way = " + std::to_string(margin) + ", " + std::to_string(way) + R"(
local cdem = require "cdem"
local T, L, b, h, E = 2e6, 2, 0.2, 0.4, 30e9
local rock = cdem.elastic{ youngs_modulus = E, poissons_ratio = 0, density = 2500 }
local function joint(t) return cdem.mohr_coulomb{ cohesion = 10 * t, friction_angle = 30, tensile_strength = t } end
local shape = cdem.cut_by_plane{ shape = cdem.box{ size = {L, b, h} }, point = {1, 0, 0}, normal = {1, 0, 0}, name = "middle" }
shape = cdem.cut_by_plane{ shape = shape, point = {0.5, 0, 0}, normal = {1, 0, 0}, name = "root" }
local model = cdem.model{ bodies = { { shape = shape, material = rock, joint = joint(T), zone_size = 0.1, bonds = "cohesive",
  joints = { middle = joint(T), root = joint(1.5 * margin * T) } } } }
model:fix{ on = "x-" }
local F, I = T * b * h^2 / 6, b * h^3 / 12
local deflection = F * L^3 / (3 * E * I) + F * L / (E / 2 * b * h * 5 / 6) -- as the middle breaks
model:fix{ on = function(x) return x > L - 1e-9 end, axes = "z", displacement = {0, 0, -way * deflection} }
model:relax{ residual = 1e-4 }
local breaks = model:breaks()
assert(#breaks > 0)
for _, bond in ipairs(breaks) do assert(math.abs(bond.place[1] - 1) < 1e-6, "the root has broken") end
)");
  INFO((warnings.empty() ? "" : warnings.front()));
  CHECK(warnings.size() <= 1);
}

TEST_CASE("a relaxation that ends while supports are on their way says how far they are", "[lua][relax]") {
  const auto warnings = warnings_of(R"(
local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }
local model = cdem.model{ bodies = { { shape = cdem.box{ size = {2, 0.2, 0.2} }, material = rock, zone_size = 0.1 } } }
model:fix{ on = "x-" }
model:fix{ on = "x+", axes = "x", displacement = {1e-3, 0, 0} }
local first = model:relax{ max_steps = 300 }
local moved = model:max("displacement.x") / 1e-3
assert(first.way_done > 0 and first.way_done < 1)
assert(math.abs(moved / first.way_done - 1) < 1e-6, moved .. " " .. first.way_done)
assert(model:relax{}.way_done == 1)
assert(math.abs(model:max("displacement.x") - 1e-3) < 1e-12)
)");
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[1].find("moved supports have gone") != std::string::npos);
}

TEST_CASE("a support that has arrived stands, however the runs after that are divided", "[lua][run]") {
  const auto hash = [](const std::string& runs) {
    return R"(
local cdem = require "cdem"
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }
local model = cdem.model{ bodies = { { shape = cdem.box{ size = {1, 0.2, 0.2} }, material = rock, zone_size = 0.1 } } }
model:fix{ on = "x-" }
model:fix{ on = "x+", displacement = {1e-4, -3e-5, 7e-6} }
model:run{ steps = 77 }
)" + runs + "return model.state_hash\n";
  };
  CHECK(warnings_of("local function one() " + hash("model:run{ steps = 30 }") + "end\nlocal function two() " +
                    hash("model:run{ steps = 11 } model:run{ steps = 19 }") + "end\nassert(one() == two())")
            .empty());
}

TEST_CASE("a bar holds its strength in one increment, whatever heavy block stands beside it",
          "[lua][relax]") {
  const double heavy = GENERATE(0.0, 5.0, 20.0), part = GENERATE(0.98, 1.02); // m; of the strength
  CAPTURE(heavy, part);
  const auto warnings =
      warnings_of("local heavy, part = " + std::to_string(heavy) + ", " + std::to_string(part) + R"(
local cdem = require "cdem"
local E, T, L, k = 1e10, 1e6, 2, 1e13
local rock = cdem.elastic{ youngs_modulus = E, poissons_ratio = 0, density = 2500 }
local bodies = { { name = "bar", shape = cdem.grid{ size = {L, 0.1, 0.1}, divisions = {20, 1, 1} }, material = rock,
  joint = cdem.mohr_coulomb{ tensile_strength = T, cohesion = 1e9, friction_angle = 0, normal_stiffness = k, shear_stiffness = k } } }
if heavy > 0 then
  bodies[2] = { name = "block", shape = cdem.grid{ size = {heavy, heavy, heavy}, divisions = {2, 2, 2}, origin = {0, 1, 0} },
    material = rock, joint = cdem.mohr_coulomb{ tensile_strength = 1e12, cohesion = 1e12, friction_angle = 0 } }
end
local model = cdem.model{ bodies = bodies, contacts = { default = cdem.coulomb{ friction_angle = 30 } } }
local function of_bar(condition) return cdem.select.where(function(x, y) return y < 0.5 and condition(x) end) end
model:fix{ on = of_bar(function(x) return x < 1e-6 end) }
model:fix{ on = of_bar(function() return true end), axes = "z" }
if heavy > 0 then
  model:fix{ on = cdem.select.where(function(_, y, z) return y > 0.5 and z < 1e-6 end) }
  model:gravity{ vector = {0, 0, -9.81} }
  model:relax{ residual = 1e-4 }
end
model:fix{ on = of_bar(function(x) return x > L - 1e-6 end), axes = "x",
           displacement = { part * T * (1 / E + 20 / L / k) * L, 0, 0 } }
assert(model:relax{ residual = 1e-4 }.converged)
assert((#model:breaks() > 0) == (part > 1))
)");
  INFO((warnings.empty() ? "" : warnings.front()));
  CHECK(warnings.size() <= 1);
}
