// Boxes that come to rest together, leaning and standing on each other.
#include "libgeom/placement/rest_together.hpp"
#include "tests/libgeom/box_surface.hpp"
#include "tests/libgeom/degree.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace geom;
using testing::box_surface;
using testing::degree;

namespace {

constexpr double clear_distance = 1e-3;

const Features& cube() {
  static const Features features = features_of(box_surface({1, 1, 1}));
  return features;
}

// The floor is level, gravity may be tilted.
const Features& ground() {
  static const Features features = features_of(box_surface({40, 20, 1}, {0, 0, -0.5}));
  return features;
}

RestOptions resting(double angle, double friction) {
  RestOptions options;
  options.down = {-std::sin(angle), 0, -std::cos(angle)};
  options.friction = friction;
  options.clear = clear_distance;
  options.step = 0.01;
  options.last_step = 1e-3;
  options.probe = 5e-3;
  options.gyration = std::sqrt(1. / 6);
  options.steps = 4000;
  return options;
}

std::vector<Pose> at(const std::vector<Vec3>& places) {
  std::vector<Pose> poses;
  for (const Vec3& x : places)
    poses.push_back({Mat3::Identity(), x});
  return poses;
}

} // namespace

TEST_CASE("cubes that hang over each other come to stand on each other") {
  const double gap = 0.05;
  std::vector<Vec3> hanging;
  for (int i = 0; i < 8; ++i)
    hanging.emplace_back(0, 0, 0.5 + i + (i + 1) * gap);
  const RestTogether rest = come_to_rest_together(cube(), at(hanging), {&ground()}, resting(0, 0.3));
  REQUIRE(rest.still);
  for (int i = 0; i < 8; ++i) {
    INFO("cube " << i);
    CHECK(rest.poses[i].translation.z() == Approx(0.5 + i + (i + 1) * clear_distance).margin(2e-4));
    CHECK(rest.poses[i].translation.head<2>().norm() < 0.1); // falls by 0.4 under gravity tilted by turns
    CHECK(rest.pressed_by[i] == (i < 7 ? 2 : 1));            // the one below or the floor, the one above
    CHECK(rest.stayed[i] == 0);
  }
}

TEST_CASE("cubes slide down an incline until they lean on each other and on a post") {
  // Steeper than twice the friction: what lies above presses on what lies below.
  const Features post = features_of(box_surface({1, 4, 4}, {-3, 0, 2}));
  const RestTogether rest =
      come_to_rest_together(cube(), at({{-1.5, 0, 0.501}, {0, 0, 0.501}, {1.3, 0, 0.501}, {2.9, 0, 0.501}}),
                            {&ground(), &post}, resting(35 * degree, std::tan(15 * degree)));
  REQUIRE(rest.still);
  for (int i = 0; i < 4; ++i) {
    INFO("cube " << i);
    CHECK(rest.poses[i].translation.x() == Approx(-2 + i + (i + 1) * clear_distance).margin(2e-3));
    CHECK(rest.poses[i].translation.z() == Approx(0.501).margin(2e-4));
    CHECK(rest.pressed_by[i] == (i < 3 ? 3 : 2)); // the floor, its neighbours
  }
}

TEST_CASE("cubes on an incline less steep than friction rest where they are") {
  const std::vector<Vec3> places{{-1.5, 0, 0.501}, {0, 0, 0.501}, {0, 0, 1.502}, {1.3, 0, 0.501}};
  const RestTogether rest =
      come_to_rest_together(cube(), at(places), {&ground()}, resting(20 * degree, std::tan(30 * degree)));
  REQUIRE(rest.still);
  for (std::size_t i = 0; i < places.size(); ++i)
    CHECK((rest.poses[i].translation - places[i]).norm() < 2e-3);
}

TEST_CASE("of two cubes that slide on the lower one is put back, the other comes to lean on it") {
  RestOptions options = resting(35 * degree, std::tan(15 * degree));
  options.way = 1;
  const RestTogether rest =
      come_to_rest_together(cube(), at({{1.4, 0, 0.501}, {0, 0, 0.501}}), {&ground()}, options);
  REQUIRE(rest.still);
  CHECK(rest.stayed == std::vector<char>{0, 1});
  CHECK(rest.poses[1].translation == Vec3(0, 0, 0.501));
  CHECK(rest.poses[0].translation.x() == Approx(1 + clear_distance).margin(2e-3));
  CHECK(rest.pressed_by == std::vector<int>{2, 1}); // of the one that stayed only those that moved
}

TEST_CASE("a cube that nothing holds is put back and stays, the others go on") {
  const Features post = features_of(box_surface({1, 1, 4}, {-1, 3, 2}));
  RestOptions options = resting(30 * degree, std::tan(15 * degree));
  options.way = 1;
  const Vec3 free(0, 0, 0.501), above(0.5, 3, 0.501);
  const RestTogether rest = come_to_rest_together(cube(), at({free, above}), {&ground(), &post}, options);
  REQUIRE(rest.still);
  CHECK(rest.stayed == std::vector<char>{1, 0});
  CHECK(rest.poses[0].translation == free);
  CHECK(rest.poses[1].translation.x() == Approx(clear_distance).margin(2e-3));
  CHECK(rest.pressed_by[1] == 2);
}
