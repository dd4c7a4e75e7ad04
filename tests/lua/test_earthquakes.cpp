// Earthquakes and bolts in scripts: records, amplitudes, quiet boundaries, free fields, damping, bolts.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

namespace {

const std::string earthquakes_head =
    "local cdem = require 'cdem'\n"
    "local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }\n"
    "local m = cdem.model{ bodies = { { name = 'rock', shape = cdem.box_mesh{ size = {1, 1, 2}, divisions = "
    "{2, 2, 4} }, "
    "material = rock } } }\n";

std::string error_with_record(const std::string& csv, const std::string& arguments) {
  Script script("local cdem = require 'cdem'\nlocal r = cdem.record{ file = 'r.csv', " + arguments +
                " }\nassert(r.duration == 0.4 and #r.times == 5)");
  script.write("r.csv", csv);
  return script.error();
}

const std::string good = "time,a,b\n0,0,0\n0.1,1,0\n0.2,0,0\n0.3,-1,0\n0.4,0,0\n";

} // namespace

TEST_CASE("a record is read from a .csv, scaled and integrated", "[lua][earthquake]") {
  CHECK(error_with_record(good, "value = 'a', unit = 'g'").empty());
  CHECK(error_with_record("# of a station\n0;0\n0.1;1\n0.2;0\n0.3;-1\n0.4;0\n",
                          "time = '1', value = '2', unit = 'm/s2', to = 'velocity', baseline = 'straight'")
            .empty());
  Script script(
      "local cdem = require 'cdem'\n"
      "local r = cdem.record{ file = 'r.csv', value = 'a', unit = 'cm/s2', scale = 100, to = 'velocity' }\n"
      "assert(math.abs(r.peak - 0.1) < 1e-12 and r.unit == 'm/s' and r.outside == 'zero')\n"
      "assert(math.abs(r.end_displacement - 0.02) < 1e-12)\n"
      "local gal = cdem.record{ file = 'r.csv', value = 'a', unit = 'Gal' }\n"
      "assert(math.abs(gal.peak - 0.01) < 1e-12 and gal.unit == 'm/s2')");
  script.write("r.csv", good);
  CHECK_THAT(script.error(), Equals(""));
}

TEST_CASE("records that are none are refused in one line", "[lua][earthquake]") {
  CHECK_THAT(error_with_record("time,a\n0,0\n0.1,1\n0.2,0\n0.9,0\n", "value = 'a', unit = 'g'"),
             Contains("r.csv") && Contains("gap from 0.2 to 0.9 s"));
  CHECK_THAT(error_with_record("time,a\n0,0\n0.1,1\n0.1,0\n", "value = 'a', unit = 'g'"),
             Contains("point 3") && Contains("sort the rows"));
  CHECK_THAT(error_with_record("time,a\n0,0\n0.1,\n", "value = 'a', unit = 'g'"),
             Contains("line 3") && Contains("an empty cell") && Contains("\"a\""));
  CHECK_THAT(error_with_record("time,a\n0,0\n0.1,nan\n", "value = 'a', unit = 'g'"), Contains("line 3"));
  CHECK_THAT(error_with_record("time,a\n0,0\n", "value = 'a', unit = 'g'"), Contains("1 point"));
  CHECK_THAT(error_with_record("time,a\n", "value = 'a', unit = 'g'"), Contains("no rows of numbers"));
  CHECK_THAT(error_with_record(good, "value = 'c', unit = 'g'"), Contains("it has: time, a, b"));
  CHECK_THAT(error_with_record(good, "value = 'a', unit = 'Pa', to = 'velocity'"),
             Contains("only an acceleration"));
}

TEST_CASE("supports, loads and gravity follow records, lists and functions", "[lua][earthquake]") {
  CHECK_THAT(
      error_of(
          earthquakes_head +
          "m:fix{ on = 'z-', velocity = {1, 0, 0}, amplitude = { {0, 0}, {1e-4, 1}, {2e-4, 0} } }\n"
          "m:traction{ on = 'z+', stress = {1e3, 0, 0}, amplitude = { times = {0, 1}, values = {0, 1} } }\n"
          "m:gravity{ vector = function(t) return {math.sin(t), 0, -9.81} end }\n"
          "m:record_reaction{ name = 'foot', on = 'z-' }\nm:record_momentum{ name = 'rock', body = 'rock' }\n"
          "m:run{ duration = 4e-4 }\n"
          "assert(math.abs(m:mean('displacement.x', 'z-') - 1e-4) < 1e-6)\n"
          "local h = m:history()\nassert(#h.foot_x == #h.time and #h.rock_z == #h.time)"),
      Equals(""));
  CHECK_THAT(error_of(earthquakes_head + "m:fix{ on = 'z-', amplitude = { {0, 0}, {1, 1} } }"),
             Contains("goes with velocity"));
  CHECK_THAT(
      error_of(earthquakes_head + "m:fix{ on = 'z-', velocity = {1, 0, 0}, amplitude = { {0, 0}, {0, 1} } }"),
      Contains("amplitude: point 2"));
  CHECK_THAT(error_of(earthquakes_head + "m:fix{ on = 'z-', velocity = {1, 0, 0}, amplitude = 3 }"),
             Contains("a list { {time, value}"));
  CHECK_THAT(
      error_of(earthquakes_head +
               "m:fix{ on = 'z-', velocity = {1, 0, 0}, amplitude = { times = {0, 1}, values = {0, 1}, "
               "outsides = 'zero' } }"),
      Contains("amplitude: outsides: no such key; did you mean outside?"));
  CHECK_THAT(error_of(earthquakes_head + "m:gravity{ vector = function(t) return 3 end }"),
             Contains("three finite numbers"));
  CHECK_THAT(error_of(earthquakes_head + "m:record_reaction{ name = 'a', on = 'nowhere' }"),
             Contains("nowhere"));
}

TEST_CASE("an amplitude's times begin at `since`", "[lua][earthquake]") {
  // The support follows the list from the moment it is given on: in the second stage it moves by the area below the list.
  CHECK_THAT(error_of(earthquakes_head +
                      "m:run{ duration = 3e-4 }\n"
                      "m:fix{ on = 'z-', velocity = {1, 0, 0}, since = m.time,\n"
                      "       amplitude = { {0, 0}, {1e-4, 1}, {2e-4, 0} } }\n"
                      "local before = m:mean('displacement.x', 'z-')\n"
                      "m:run{ duration = 4e-4 }\n"
                      "assert(math.abs(m:mean('displacement.x', 'z-') - before - 1e-4) < 1e-6)\n"
                      "local least = math.huge\n"
                      "m:force{ on = 'z+', force = {1, 0, 0}, since = m.time,\n"
                      "         amplitude = function(t) least = math.min(least, t); return 1 end }\n"
                      "least = math.huge\nm:run{ duration = 1e-4 }\nassert(math.abs(least) < 1e-12, least)"),
             Equals(""));
  CHECK_THAT(error_of(earthquakes_head + "m:traction{ on = 'z+', stress = {1, 0, 0}, since = 1 }"),
             Contains("since: goes with amplitude"));
}

TEST_CASE("without a callback `every` is of the history", "[lua]") {
  CHECK_THAT(error_of(earthquakes_head +
                      "m:initial_velocity{ velocity = {0, 0, 1e-3} }\n"
                      "m:run{ steps = 40, every = 4 }\n"
                      "local h = m:history()\nassert(h.time[1] == 0 and h.step[1] == 0 and h.step[2] == 4)\n"
                      "assert(#h.time == 11 or #h.time == 12)\n"
                      "m:run{ steps = 40 }\nassert(#m:history().time >= 20)"),
             Equals(""));
}

TEST_CASE("quiet boundaries and free fields in a script", "[lua][earthquake]") {
  CHECK_THAT(error_of(earthquakes_head +
                      "m:quiet{ on = 'z-', velocity = {0, 0, 1}, amplitude = { times = {0, 1e-4, "
                      "2e-4}, values = {0, 1, 0},"
                      " outside = 'zero' } }\n"
                      "m:free_field{ on = {'x-', 'x+'} }\nm:run{ duration = 5e-3 }\n"
                      "local e = m:energy()\nassert(e.radiated > 0 and e.balance_error < 0.01)"),
             Equals(""));
  CHECK_THAT(error_of(earthquakes_head + "m:quiet{ on = 'z-', velocity = {0, 0, 1}, stress = {0, 0, 1} }"),
             Contains("give one of them"));
  CHECK_THAT(error_of(earthquakes_head + "m:quiet{ on = 'z-', amplitude = { {0, 0}, {1, 1} } }"),
             Contains("goes with velocity or stress"));
  CHECK_THAT(error_of(earthquakes_head + "m:free_field{ on = 'x-' }"), Contains("no foot"));
}

TEST_CASE("Rayleigh damping by a fraction of critical damping", "[lua][earthquake]") {
  CHECK_THAT(error_of("local cdem = require 'cdem'\n"
                      "local w = 2 * math.pi * 5\n"
                      "local function of(part) return cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = "
                      "0.2, density = "
                      "2000, damping = { fraction = 0.05, frequency = 5, of = part } } end\n"
                      "for _, part in ipairs{ 'both', 'mass', 'stiffness' } do\n"
                      "  local r = of(part)\n"
                      "  assert(math.abs(r.viscosity / r.density / (2 * w) + r.stiffness_damping * w / 2 - "
                      "0.05) < 1e-12)\n"
                      "end\nassert(of('mass').stiffness_damping == 0 and of('stiffness').viscosity == 0)"),
             Equals(""));
}

TEST_CASE("bolts in a script", "[lua][bolts]") {
  CHECK_THAT(
      error_of(earthquakes_head +
               "m:fix{ on = 'z-' }\n"
               "assert(m:bolts{ from = {0.5, 0.5, 2}, to = {0.5, 0.5, 0.5}, area = 5e-4, plate = true, "
               "free_length = 1,"
               " pretension = 1e4 } == 1)\n"
               "assert(m:bolts{ pattern = { centre = {0.5, 0.5, 1}, axis = 'y', radius = 0.1, length = 0.3, "
               "angles = "
               "{0, 90, 180}, at = {0.3, 0.7} }, area = 1e-4 } == 6)\n"
               "local rows = m:bolt_forces()\nassert(#rows == 77 and math.abs(rows[1].tension - 1e4) < 1)\n"
               "m:relax{ residual = 1e-6 }\nm:save_bolts{}\nm:picture{ file = 'bolts.png' }"),
      Equals(""));
  CHECK_THAT(error_of(earthquakes_head + "m:bolts{ from = {0.5, 0.5, 2}, to = {0.5, 0.5, 3}, area = 5e-4 }"),
             Contains("bolt 1 of 1") && Contains("hangs in the air"));
  CHECK_THAT(error_of(earthquakes_head + "m:save_bolts{}"), Contains("no bolts"));
  CHECK_THAT(Script(earthquakes_head + "m:bolts{ from = {0.5, 0.5, 2}, to = {0.5, 0.5, 0.5}, area = 490 }")
                 .printed(),
             Contains("bolts: area = 490: is it in m2? A bar of 25 mm"));
}

// Newmark's block on a ground that shakes up and down. A friction that lags behind its normal force holds it altogether.
TEST_CASE("a deformable block slides while a ground that shakes upwards takes weight off it",
          "[lua][contact]") {
  Script script(R"(
local cdem = require "cdem"
local g, frequency, cycles, pull = 9.81, 50, 4, 0.45
local stone = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }
local floor = cdem.box_mesh{ size = {8, 4, 0.5}, divisions = {8, 4, 1}, origin = {-3, -2, -0.5} }
local block = cdem.box_mesh{ size = {1, 1, 0.5}, divisions = {2, 2, 1}, origin = {0.03, 0.02, 0} }
local m = cdem.model{ bodies = { { name = "floor", shape = floor, material = stone, element = "rigid" },
                                 { name = "block", shape = block, material = stone } },
                      contacts = { { "floor", "block", cdem.coulomb{ friction_angle = 30, restitution = 0.5 } } } }
m:fix{ on = "floor" }
m:gravity{ vector = {pull * g, 0, -g} }
m:relax{}
local begin, start, omega = m.time, m:mean("displacement.x", "block"), 2 * math.pi * frequency
m:fix{ on = "floor", velocity = {0, 0, 0.5 * g / omega}, amplitude = function(t) return math.cos(omega * (t - begin)) - 1 end }
m:run{ duration = cycles / frequency }
local v, x, dt = 0, 0, 1 / frequency / 2000
for i = 1, cycles * 2000 do
  local a = pull * g - math.tan(math.rad(30)) * (g - 0.5 * g * math.sin(omega * i * dt))
  if v > 0 or a > 0 then v = math.max(0, v + a * dt) end
  x = x + v * dt
end
local slid = m:mean("displacement.x", "block") - start
assert(math.abs(slid / x - 1) < 0.1, "slid " .. slid .. " m where a rigid block slides " .. x)
)");
  script.run();
}

TEST_CASE("a deformable block face on face slides by Newmark's law if its material is damped",
          "[lua][contact][newmark]") {
  Script script(R"(
local cdem = require "cdem"
local g, push, duration, modulus, density = 9.81, 0.6, 0.3, 10e9, 2500
local sine, cosine, friction = math.sin(math.rad(25)), math.cos(math.rad(25)), math.tan(math.rad(40))
local stone = cdem.elastic{ youngs_modulus = modulus, poissons_ratio = 0.2, density = density,
                            stiffness_damping = 0.05 * 4^(1/3) * math.sqrt(density / modulus) }
local m = cdem.model{
  bodies = { { name = "plane", material = stone, shape = cdem.box{ size = {8, 4, 1}, origin = {-2, -1, -1} } },
             { name = "block", material = stone, shape = cdem.box{ size = {2, 2, 1} } } },
  contacts = { { "plane", "block", cdem.coulomb{ friction_angle = 40 } } } }
m:fix{ on = "plane" }
m:gravity{ vector = {g * sine, 0, -g * cosine} }
m:relax{}
m:gravity{ vector = {g * (sine + push * cosine), 0, -g * (cosine - push * sine)} }
m:run{ duration = duration }
m:gravity{ vector = {g * sine, 0, -g * cosine} }
m:run{ duration = 0.45 }
local speeds_up = g * (sine + push * cosine - friction * (cosine - push * sine))
local slows_down = g * (friction * cosine - sine)
local newmark = speeds_up * duration^2 / 2 * (1 + speeds_up / slows_down)
local slid = m:mean("displacement.x", "block")
assert(math.abs(slid / newmark - 1) < 0.01, "slid " .. slid .. " m where Newmark's block slides " .. newmark)
)");
  script.run();
}

TEST_CASE("the friction of a plate does not feel what presses on its deformable ground far off",
          "[lua][contact]") {
  Script script(R"(
local cdem = require "cdem"
local stone = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }
local rough = cdem.coulomb{ friction_angle = 30, restitution = 0.5 }
local function slid(pressure)
  local m = cdem.model{
    bodies = { { name = "floor", material = stone,
                 shape = cdem.box_mesh{ size = {6, 2, 0.5}, divisions = {12, 4, 1}, origin = {-1, -0.5, -0.5} } },
               { name = "plate", material = stone,
                 shape = cdem.box_mesh{ size = {1, 1, 0.25}, divisions = {2, 2, 1}, origin = {-0.47, 0.02, 0} } },
               { name = "heavy", material = stone,
                 shape = cdem.box_mesh{ size = {1, 1, 1}, divisions = {2, 2, 2}, origin = {3.03, 0.02, 0} } } },
    contacts = { { "floor", "plate", rough }, { "floor", "heavy", rough } } }
  m:fix{ on = cdem.select.plane{ point = {0, 0, -0.5}, normal = {0, 0, 1} } }
  m:fix{ on = "heavy", axes = "xy" }
  m:gravity{ vector = {0, 0, -9.81} }
  m:relax{}
  local begin = m.time
  m:gravity{ vector = {0.65 * 9.81, 0, -9.81} }
  m:traction{ on = cdem.select.plane{ point = {0, 0, 1}, normal = {0, 0, 1} }, pressure = pressure,
              amplitude = function(t) return (t - begin) / 0.05 end }
  m:run{ duration = 0.05 }
  return m:mean("displacement.x", "plate")
end
local alone, beside = slid(1), slid(2e6)
assert(math.abs(beside / alone - 1) < 0.02, "slid " .. beside .. " m beside, " .. alone .. " m alone")
)");
  script.run();
}
