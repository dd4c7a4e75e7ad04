// Bodies that go down to their rest: where a box stands, slides or topples on an incline is known.
#include "libgeom/placement/features.hpp"
#include "libgeom/placement/rest.hpp"
#include "tests/libgeom/box_surface.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace geom;
using testing::box_surface;

namespace {

constexpr double clear_distance = 1e-3;

RestOptions resting(double friction) {
  RestOptions options;
  options.friction = friction;
  options.clear = clear_distance;
  options.step = 0.03;
  options.last_step = 1e-3;
  options.probe = 5e-3;
  options.gyration = 0.4;
  options.steps = 2000;
  options.way = 3;
  return options;
}

// A box whose lower face lies on a plane that rises along x, and what becomes of it.
struct OnIncline {
  Rest rest;
  double way = 0, turn = 0; // m, radians

  OnIncline(const Vec3& size, double angle, double friction) {
    const Mat3 tilt = Eigen::AngleAxisd(-angle, Vec3::UnitY()).toRotationMatrix();
    Surface plane = box_surface({20, 20, 1}, {0, 0, -0.5});
    for (Vec3& x : plane.points)
      x = tilt * x;
    const Features ground = features_of(plane);
    const Pose start{tilt, tilt * Vec3(0, 0, 0.5 * size.z() + clear_distance)};
    rest = come_to_rest(features_of(box_surface(size)), start, {&ground}, resting(friction));
    way = (rest.pose.translation - start.translation).norm();
    turn = Eigen::AngleAxisd(tilt.transpose() * rest.pose.rotation).angle();
  }
};

// Depths count as far as the reach, less than the boxes are thick.
double least_gap(const Surface& one, const Surface& other) {
  const Features a = features_of(one), b = features_of(other);
  const double reach = 0.2;
  std::vector<Touch> touches;
  NearFeatures(a, b, reach).touches(a, b, reach, touches);
  double least = reach;
  for (const Touch& touch : touches)
    least = std::min(least, touch.gap);
  return least;
}

} // namespace

TEST_CASE("only what stands out of a box can touch: its corners and edges") {
  const Features cube = features_of(box_surface({1, 1, 1}));
  CHECK(cube.faces.size() == 48);
  CHECK(cube.edges.size() == 24);   // twelve in two pieces
  CHECK(cube.corners.size() == 20); // eight, and the middles of twelve edges
}

TEST_CASE("the gap between features is the distance of the solids, and their depth when they overlap") {
  const Surface cube = box_surface({1, 1, 1});
  CHECK(least_gap(box_surface({1, 1, 1}, {0.2, 0.3, 1.1}), cube) == Approx(0.1));    // face over face
  CHECK(least_gap(box_surface({1, 1, 1}, {0.2, 0.3, 0.98}), cube) == Approx(-0.02)); // into it
  const Mat3 quarter = Eigen::AngleAxisd(M_PI / 4, Vec3::UnitY()).toRotationMatrix(),
             other = Eigen::AngleAxisd(M_PI / 4, Vec3::UnitX()).toRotationMatrix();
  for (const double gap : {0.05, -0.03}) { // edge across edge
    Surface above = cube, below = cube;
    for (Vec3& x : above.points)
      x = quarter * x + Vec3(0.1, 0.1, 2 * std::sqrt(0.5) + gap);
    for (Vec3& x : below.points)
      x = other * x + Vec3(0.1, 0.1, 0);
    CHECK(least_gap(above, below) == Approx(gap));
  }
}

TEST_CASE("a box rests on an incline less steep than its friction, and slides on a steeper one") {
  const OnIncline held({1, 1, 1}, 20 * M_PI / 180, std::tan(25 * M_PI / 180)),
      sliding({1, 1, 1}, 20 * M_PI / 180, std::tan(15 * M_PI / 180));
  CHECK(held.rest.still);
  CHECK(held.way < 1e-3);
  CHECK_FALSE(sliding.rest.still);
  CHECK(sliding.way >= 3); // no further is it followed
  CHECK(sliding.turn < 0.01);
}

TEST_CASE("a column topples where its centroid is beside its foot, and lies then") {
  // Height over width 3: at 18.4 degrees.
  const OnIncline stands({1, 1, 3}, 13 * M_PI / 180, 2), topples({1, 1, 3}, 20 * M_PI / 180, 2);
  CHECK(stands.rest.still);
  CHECK(stands.turn < 0.01);
  CHECK(topples.rest.still);
  CHECK(topples.turn == Approx(M_PI / 2).margin(0.01));
}

TEST_CASE("a cube slides until two posts hold it") {
  // A cube of side 1 on its face slides down until two posts hold it, one gap from each.
  const double angle = 30 * M_PI / 180;
  const Vec3 down(-std::sin(angle), 0, -std::cos(angle)); // the floor is level, gravity is not
  const Features floor = features_of(box_surface({20, 20, 1}, {0, 0, -0.5})),
                 left = features_of(box_surface({0.2, 0.2, 2}, {-1.5, 0.4, 1})),
                 right = features_of(box_surface({0.2, 0.2, 2}, {-1.5, -0.3, 1}));
  RestOptions options = resting(0.1);
  options.down = down;
  const Rest rest =
      come_to_rest(features_of(box_surface({1, 1, 1})), {Mat3::Identity(), {0, 0, 0.5 + clear_distance}},
                   {&floor, &left, &right}, options);
  CHECK(rest.still);
  // The face of the cube one gap from the posts' faces at x = -1.4.
  CHECK(rest.pose.translation.x() == Approx(-1.4 + clear_distance + 0.5).margin(2e-4));
  CHECK(rest.pose.translation.z() == Approx(0.5 + clear_distance).margin(2e-4));
  CHECK(rest.carried_by == std::vector<char>{1, 1, 1});
  options.friction = 0.8; // enough to stay where it is, away from the posts
  const Rest above =
      come_to_rest(features_of(box_surface({1, 1, 1})), {Mat3::Identity(), {0, 0, 0.5 + clear_distance}},
                   {&floor, &left, &right}, options);
  CHECK(above.still);
  CHECK(above.carried_by == std::vector<char>{1, 0, 0});
}

TEST_CASE("a body inside others' clear distance is pushed out by as much as it lacks") {
  const Features floor = features_of(box_surface({20, 20, 1}, {0, 0, -0.5}));
  const Pose start{Mat3::Identity(), {0, 0, 0.5 + 0.3 * clear_distance}};
  const Pose pose = pushed_clear(features_of(box_surface({1, 1, 1})), start, {&floor}, resting(0));
  CHECK(pose.translation.z() == Approx(0.5 + clear_distance).epsilon(1e-5));
  CHECK((pose.translation - start.translation).head<2>().norm() < 1e-9);
}

TEST_CASE("cubes side by side on a plane push on each other's sides where one has entered the other") {
  // By 1e-3, and 1e-6 lower or higher: the corners that entered are next to the lower or the upper face.
  for (const double lower : {1e-6, -1e-6}) {
    const Features one = features_of(box_surface({1, 1, 1})),
                   other = features_of(box_surface({1, 1, 1}, {0.999, 0.3, -lower}));
    std::vector<Touch> touches;
    NearFeatures(one, other, 0.01).touches(one, other, 0.01, touches);
    int sideways = 0;
    for (const Touch& touch : touches)
      if (touch.gap < 0) {
        CHECK(std::abs(touch.normal.x()) == Approx(1).epsilon(1e-6));
        CHECK(touch.gap == Approx(-1e-3).epsilon(1e-6));
        ++sideways;
      }
    CHECK(sideways >= 3);
  }
}
