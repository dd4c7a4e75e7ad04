// Results of fracture as a script reads them.
#include "tests/lua/script.hpp"

#include <catch2/catch.hpp>

using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

// Two blocks of 1 m, held at x-, that part brittle when pulled at x+.
std::string pulled_apart() {
  return opening +
         "local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0, density = 2000 }\n"
         "local joint = cdem.mohr_coulomb{ cohesion = 1e6, friction_angle = 30, tensile_strength = 1e5 }\n"
         "local model = cdem.model{ bodies = { { shape = cdem.grid{ size = {2, 1, 1}, divisions = {2, 1, 1} "
         "},\n"
         "  material = rock, joint = joint, name = 'column', element = 'small_strain' } } }\n"
         "model:fix{ on = 'x-', axes = 'xyz' }\n"
         "model:fix{ on = 'x+', axes = 'x', velocity = {1, 0, 0} }\n";
}

const std::string run = "model:run{ duration = 0.01 }\n";

} // namespace

TEST_CASE("cracks: area and energy as tables, of the model and of bodies, and as histories",
          "[lua][cracks]") {
  CHECK(error_of(
            pulled_apart() +
            "assert(model:cracks().area == 0)\n"
            "model:record_cracks{}\nmodel:record_cracks{ name = 'mine', body = 'column' }\n" +
            run +
            "local c = model:cracks()\n"
            "close(c.area, 1)\nclose(c.tension_area, 1)\nassert(c.shear_area == 0 and c.damaged_area == 0)\n"
            "close(c.energy, model:energy().breaking)\nassert(c.energy > 0)\n"
            "assert(c.bodies.column.area == c.area and c.between.area == 0)\n"
            "local h = model:history()\n"
            "assert(h.crack_area[#h.crack_area] == c.area)\n"
            "assert(h.mine_tension_energy[#h.time] == c.tension_energy)\n"
            "model:chart{ file = 'cracks.png', x = 'time', y = {'crack_area'}, right = {'crack_energy'},\n"
            "  size = {320, 240} }\n") == "");
  CHECK_THAT(error_of(pulled_apart() + "model:record_cracks{ body = 'colum' }"), Contains("column"));
  CHECK_THAT(error_of(pulled_apart() + "model:record_cracks{}\nmodel:record_cracks{}"),
             Contains("record_cracks: name = \"crack\""));
}

TEST_CASE("cracks: the tip along a path, and refusals of paths", "[lua][cracks]") {
  CHECK(
      error_of(
          pulled_apart() + run +
          "local tip = model:crack_tip{ point = {1, 0, 0}, direction = {0, 1, 0}, width = 1.1, reach = 2 }\n"
          "close(tip.tip.position, 1)\nassert(#tip.position == #tip.time and #tip.speed == #tip.time)\n"
          "close(tip.rayleigh_speed, cdem.rayleigh_speed(rock))\n"
          "close(cdem.rayleigh_speed(rock), math.sqrt(1e9 / 4000 * (3 - math.sqrt(5))), 1e-12)\n"
          "local none = model:crack_tip{ path = {{5, 0, 0}, {5, 1, 0}}, width = 0.1 }\n"
          "assert(none.tip == nil and #none.time == 0)\n") == "");
  CHECK_THAT(error_of(pulled_apart() + "model:crack_tip{ width = 1 }"),
             Contains("give either path, a list of places, or point and direction"));
  CHECK_THAT(error_of(pulled_apart() + "model:crack_tip{ point = {0, 0, 0}, width = 1 }"),
             Contains("give either path"));
  CHECK_THAT(error_of(pulled_apart() + "model:crack_tip{ path = {{0, 0, 0}, {0, 0, 0}}, width = 1 }"),
             Contains("path[2]: the same place as path[1]"));
}

TEST_CASE("cracks: the surface and the fragments as files and charts", "[lua][cracks]") {
  Script script(pulled_apart() + run +
                "model:save_cracks{ file = 'cracks.vtp', series = 'all.pvd' }\n"
                "model:save_cracks{ file = 'more.vtp', damaged = true, series = 'all.pvd' }\n"
                "model:save_fragments{ file = 'fragments.csv' }\n"
                "model:picture{ file = 'ranks.png', colour = 'fragment', size = {200, 200} }\n"
                "model:chart_fragments{ file = 'sizes.png', size = {320, 240} }\n"
                "local list, t = model:fragments(), cdem.read_csv('fragments.csv')\n"
                "assert(#list == 2 and #t.mass == 2)\n"
                "local sum = 0\n"
                "for i, f in ipairs(list) do\n"
                "  close(f.mass, 2000)\n  assert(f.body == 'column' and t.body[i] == 1)\n"
                "  close(f.diameter, (6 / math.pi) ^ (1 / 3))\n"
                "  close(t.momentum_x[i], f.momentum[1])\n"
                "  close(f.kinetic_energy, f.translation_energy + f.rotation_energy + f.rest_energy)\n"
                "  sum = sum + f.kinetic_energy\nend\n"
                "close(sum, model:energy().kinetic)\n");
  CHECK(script.error() == "");
  CHECK_THAT(script.read("cracks.vtp"), Contains("PolyData") && Contains("opening") && Contains("time"));
  CHECK(script.read("all.pvd").find("more.vtp") != std::string::npos);
  CHECK(script.read("ranks.png").rfind("\x89PNG", 0) == 0);
  CHECK(script.read("sizes.png").rfind("\x89PNG", 0) == 0);
  CHECK_THAT(error_of(pulled_apart() + "model:save_cracks{ file = 'cracks.stl' }"), Contains(".vtp"));
}

TEST_CASE("cracks: the log says once that the first of them shortens the time step", "[lua][cracks]") {
  Script script(opening + R"(
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400 }
local law = cdem.mohr_coulomb{ cohesion = 6e6, friction_angle = 30, tensile_strength = 3e6, softening = "exponential",
                               fracture_energy_1 = 100, fracture_energy_2 = 1000 }
local bar = cdem.box_mesh{ size = {0.2, 0.05, 0.05}, divisions = {8, 2, 2}, jitter = 0.1 }
local model = cdem.model{ bodies = { { name = "bar", shape = bar, material = rock, joint = law } } }
model:fix{ on = "x-" }
model:fix{ on = "x+", axes = "x", velocity = {0.2, 0, 0} }
local steps = {}
for i = 1, 6 do steps[i] = model:run{ duration = 5e-5 }.time_step end
assert(steps[6] < 0.5 * steps[1])
)");
  CHECK(script.error() == "");
  const auto told = those_with(script.listener->lines, "the time step fell from ");
  REQUIRE(told.size() == 1);
  CHECK_THAT(told[0], Contains(" s: faces that crack are stiff"));
}

TEST_CASE("cracks: a J integral is refused where it makes no sense", "[lua][cracks]") {
  CHECK_THAT(error_of(pulled_apart() +
                      "model:j_integral{ point = {1, 1, 0}, front = {0, 0, 1}, growth = {0, 1, 0}, "
                      "radii = {0.5} }"),
             Contains("needs a meshed body that deforms"));
  CHECK_THAT(error_of(pulled_apart() +
                      "model:j_integral{ point = {1, 1, 0}, front = {0, 0, 1}, growth = {0, 0, 1}, "
                      "radii = {0.5} }"),
             Contains("growth = {0, 0, 1}: must be square to the front"));
  CHECK_THAT(error_of(pulled_apart() +
                      "model:j_integral{ point = {1, 1, 0}, front = {0, 0, 1}, growth = {0, 1, 0}, "
                      "radii = {0.5}, inner = 1 }"),
             Contains("inner"));
}
