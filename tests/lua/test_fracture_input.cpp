// Mass scaling, scattering strength, rate effect, joints of regions and process zones as scripts give and meet them.
#include "tests/lua/script.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace cdem::script;
using namespace cdem::script::test;
using Catch::Matchers::Contains;

namespace {

// A bar of two regions that may crack anywhere; `body` and `joint` are what follows the fields that are there.
std::string bar(const std::string& body = "", const std::string& joint = "",
                const std::string& size = "0.1") {
  return opening +
         "local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400 }\n" +
         "local function law(strength) return cdem.mohr_coulomb{ cohesion = 2 * strength, friction_angle = "
         "30, " +
         "tensile_strength = strength, softening = 'linear', fracture_energy_1 = 100, fracture_energy_2 = "
         "1000" +
         joint + " } end\n" +
         "local solid = cdem.grid{ size = {0.6, 0.2, 0.2}, divisions = {2, 1, 1} }:solid()\n" +
         "local model = cdem.model{ bodies = { { shape = solid:mesh{ size = " + size +
         " }, material = concrete, joint = law(3e6), bonds = 'cohesive', name = 'bar'" + body + " } } }\n" +
         "model:fix{ on = 'x-', axes = 'x', velocity = {-0.1, 0, 0} }\n" +
         "model:fix{ on = 'x+', axes = 'x', velocity = {0.1, 0, 0} }\n";
}

std::vector<std::string> lines_of(const std::string& text, const std::string& with, bool check_only = false) {
  Script script(text);
  script.settings.check_only = check_only;
  script.run();
  std::vector<std::string> found;
  for (const std::string& line : script.listener->lines)
    if (line.find(with) != std::string::npos)
      found.push_back(line);
  return found;
}

} // namespace

TEST_CASE("mass_scaling: the result, the log and the warnings tell of it", "[lua][mass_scaling]") {
  const std::string run = "local r = model:run{ steps = 400, mass_scaling = { factor = 8 } }\n"
                          "assert(r.mass_scaling.added_mass > 0.05 and r.mass_scaling.body == 'bar')\n"
                          "assert(r.mass_scaling.kinetic_energy > 0)\n"
                          "assert(model:energy().balance_error < 0.01)\n";
  const auto told = lines_of(bar() + run, "run: mass_scaling:");
  REQUIRE(told.size() == 2);
  CHECK_THAT(told[0], Contains("time step ") && Contains("of the mass added") && Contains("of \"bar\"") &&
                          Contains("kinetic energy"));
  CHECK_THAT(told[1], Contains("warning: ") && Contains("was added (more than 5 %)"));
  CHECK(lines_of(bar() + "assert(not model:run{ steps = 5 }.mass_scaling)", "mass_scaling").empty());
}

TEST_CASE("mass_scaling: wrong input is refused in one line", "[lua][mass_scaling]") {
  const auto refused = [](const std::string& arguments) {
    return error_of(bar() + "model:run{ steps = 1, " + arguments + " }");
  };
  CHECK_THAT(refused("mass_scaling = {}"), Contains("mass_scaling: give step (s) or factor"));
  CHECK_THAT(refused("mass_scaling = { step = 1e-5, factor = 2 }"), Contains("not both"));
  CHECK_THAT(refused("mass_scaling = { factor = 0 }"),
             Contains("mass_scaling.factor = 0: must be at least 1"));
  CHECK_THAT(refused("mass_scaling = { step = -1 }"), Contains("mass_scaling.step = -1: must be > 0"));
  CHECK_THAT(refused("mass_scaling = { step = 1e-5 }, time_step = 1e-6"), Contains("leave time_step out"));
  CHECK_THAT(refused("mass_scaling = { steps = 2 }"), Contains("step"));
}

TEST_CASE("weibull: a script scatters strength by a seed", "[lua][scatter]") {
  const auto first = [](int seed) {
    const std::string weibull =
        ", weibull = { modulus = 8, reference_volume = 1e-3, seed = " + std::to_string(seed) + " }";
    return lines_of(bar("", weibull) + "model:run{ steps = 150 }; print('hash ' .. model.state_hash)",
                    "hash ");
  };
  const std::vector<std::string> one = first(1);
  REQUIRE(one.size() == 1);
  CHECK(one == first(1));
  CHECK(one != first(2));
}

TEST_CASE("weibull and rate_effect: wrong input is refused in one line", "[lua][scatter][rate]") {
  const auto refused = [](const std::string& joint) { return error_of(bar("", joint)); };
  CHECK_THAT(refused(", weibull = { modulus = 1, reference_volume = 1, seed = 1 }"),
             Contains("weibull.modulus = 1: must be in [2, 1000]"));
  CHECK_THAT(refused(", weibull = { modulus = 8, reference_volume = 0, seed = 1 }"),
             Contains("weibull.reference_volume = 0"));
  CHECK_THAT(refused(", weibull = { modulus = 8, reference_volume = 1 }"),
             Contains("weibull: seed: missing"));
  CHECK_THAT(refused(", rate_effect = { reference_rate = 0, exponent = 0.018 }"),
             Contains("rate_effect.reference_rate = 0"));
  CHECK_THAT(refused(", rate_effect = { reference_rate = 1e-6, exponent = 0.018, change_rate = 10 }"),
             Contains("change_rate and exponent_above go together"));
  CHECK_THAT(refused(", rate_effect = { reference_rate = 1e-6, exponent = 0.1, change_rate = 1e-7, "
                     "exponent_above = 0.3 }"),
             Contains("rate_effect.change_rate = 1e-07: must be above reference_rate"));
}

TEST_CASE("region_joints: regions by number, each pair a joint of its own", "[lua][regions]") {
  CHECK(
      lines_of(bar(", region_joints = { {1, 2, law(1e6)} }") + "print(#model:process_zones())", "2").size() ==
      1);
  CHECK_THAT(error_of(bar(", region_joints = { {1, 3, law(1e6)} }")),
             Contains("region_joints[1] = 3: must be regions of the mesh of body \"bar\" (1 to 2)"));
  CHECK_THAT(error_of(bar(", region_joints = { {1, 2, law(1e6)}, {2, 1, law(2e6)} }")),
             Contains("given once"));
}

TEST_CASE("process zone: a mesh too coarse for it is warned of once, in a check too", "[lua][process_zone]") {
  const bool check_only = GENERATE(false, true);
  const auto coarse = lines_of(bar("", "", "0.19") + "model:run{ steps = 1 }", "process zone", check_only);
  REQUIRE(coarse.size() == 1);
  CHECK_THAT(coarse[0], Contains("warning: ") && Contains("of \"bar\": 0.347 m") &&
                            Contains("fewer than 3") && Contains("faces of at most 0.102 m"));
  CHECK(lines_of(bar("", "", "0.08") + "model:run{ steps = 1 }", "process zone", check_only).empty());
}

TEST_CASE("process zone: the summary of a check has it, and a script can ask", "[lua][process_zone]") {
  Script script(bar("", "", "0.08") +
                "local z = model:process_zones()[1]\nclose(z.length, 30e9 / 0.96 * 100 / 9e12)\n"
                "close(z.largest_face_size, 0.88 * z.length / 3)");
  script.settings.check_only = true;
  script.run();
  CHECK_THAT(script.engine->model_summary(),
             Contains("process zone E' G_I / T^2 of \"bar\": 0.347 m; faces of 0.0") &&
                 Contains("at most 0.102 m serves"));
}

TEST_CASE("slivers of a breakable mesh are told of with their step, in a check too", "[lua][slivers]") {
  // A thin slab on a cube, as one solid: its tetrahedra are a fiftieth of the others high.
  const std::string type = GENERATE("springs", "cohesive");
  const std::string text =
      opening + "local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400 }\n" +
      "local law = cdem.mohr_coulomb{ cohesion = 6e6, friction_angle = 30, tensile_strength = 3e6 }\n" +
      "local box = cdem.solid.box\nlocal solid = cdem.solid.fragments{ solids = { box{ size = {1, 1, 1} }, "
      "box{ size = {1, 1, 0.02}, origin = {0, 0, 1} } } }\n"
      "local model = cdem.model{ bodies = { { shape = solid:mesh{ size = 0.5 }, material = rock, joint = "
      "law, "
      "bonds = '" +
      type + "', name = 'slab' } } }\nmodel:gravity{ vector = {0, 0, -9.81} }\nmodel:run{ steps = 1 }";
  const auto told = lines_of(text, "need a time step of", GENERATE(false, true));
  REQUIRE(told.size() == 1);
  CHECK_THAT(told[0],
             Contains("elements of \"slab\"") && Contains("the others allow") && Contains("mass_scaling"));
}
