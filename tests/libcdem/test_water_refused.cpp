// What a model refuses of water, and says why.
#include "libcdem/load/water_forces.hpp"
#include "libcdem/water/steady_wave.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/going_on.hpp"
#include "tests/libcdem/in_water.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

TEST_CASE("buoyancy may not be given twice", "[water][input]") {
  System s(build({meshed("unit", geom::box_mesh({1, 1, 1}, {2, 2, 2}))}));
  s.conditions.gravity = gravity();
  s.conditions.gravity->water_density = 1000;
  s.conditions.flows = {in_water(cdem::uniform_water(still(0.5)))};
  CHECK_THROWS_WITH(cdem::resolve(s.model, s.state, s.conditions), Catch::Contains("buoyancy already"));
}

TEST_CASE("bodies and the water that carries them have one gravity", "[water][input]") {
  System s(build({meshed("unit", geom::box_mesh({1, 1, 1}, {2, 2, 2}))}));
  const auto error = [&](const Vec3& acceleration, double of_water) {
    cdem::UniformWater water = still(0.5);
    water.gravity = of_water;
    s.conditions.gravity = gravity(acceleration);
    s.conditions.flows = {in_water(cdem::uniform_water(water))};
    try {
      cdem::resolve(s.model, s.state, s.conditions);
    } catch (const geom::InputError& refused) {
      return std::string(refused.what());
    }
    return std::string();
  };
  CHECK(error({0, 0, -9.80665}, 9.81).empty());
  CHECK(error({0, 0, -1.62}, 1.62).empty());
  CHECK_THAT(error({0, 0, -1.62}, 9.81), Catch::Contains("must be (0, 0, -9.81) m/s2"));
  CHECK_THAT(error({0, -9.81, 0}, 9.81), Catch::Contains("gravity = {0, -9.81, 0}"));
  CHECK_THAT(error({1, 0, -9.81}, 9.81), Catch::Contains("level in z"));
  cdem::ModelSpec spec;
  spec.bodies = {meshed("unit", geom::box_mesh({1, 1, 1}, {2, 2, 2}))};
  cdem::Simulation given(spec, 1, nullptr);
  cdem::Gravity grows = gravity({0, 0, -9.81});
  grows.amplitude = [](double time) { return std::min(1.0, time); };
  given.gravity(grows);
  given.flow(in_water(cdem::uniform_water(still(0.5))));
  CHECK_THROWS_WITH(given.check_run(0.5, 2), Catch::Contains("gravity: amplitude"));
  CHECK_NOTHROW(given.check_run(1, 2));
  cdem::RunOptions options;
  options.steps = 1;
  CHECK_THROWS_WITH(given.run(options), Catch::Contains("0 at t = 0 s"));
  given.gravity(gravity({0, 0, -9.81}));
  CHECK_NOTHROW(given.run(options));
}
