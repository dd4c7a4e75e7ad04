// Directions on a Schmidt net beside closed forms.
#include "libgeom/assembly/discs.hpp"
#include "libgeom/core/stereonet.hpp"
#include "libgeom/placement/pile.hpp"
#include "tests/libgeom/degree.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace geom;
using testing::degree;

TEST_CASE("poles stand where the formula of the equal-area net puts them") {
  // 30/090: the pole plunges by 60 degrees to the west, sqrt(2) sin(15 deg) from the centre.
  CHECK((pole_on_net({30 * degree, 90 * degree}) - Eigen::Vector2d(-std::sqrt(2.) * std::sin(15 * degree), 0))
            .norm() < 1e-15);
  CHECK(pole_on_net({30 * degree, 90 * degree}).x() == Approx(-0.366025403784));
  CHECK(pole_on_net({0, 77 * degree}).norm() == 0);                               // level: in the centre
  CHECK((pole_on_net({90 * degree, 0}) - Eigen::Vector2d(0, -1)).norm() < 1e-15); // upright: on the rim
  CHECK((pole_on_net({60 * degree, 225 * degree}) - Eigen::Vector2d(0.5, 0.5)).norm() <
        1e-15); // sqrt(2) sin(30 deg), north-east
}

TEST_CASE("the pole of a plane is its normal on the net, whichever way the normal points") {
  for (const double dip : {1., 30., 60., 89.})
    for (const double direction : {0., 37., 90., 181., 300., 359.}) {
      const Vec3 normal = normal_of_dip(dip * degree, direction * degree);
      const Orientation o{dip * degree, direction * degree};
      CHECK((on_net(normal) - pole_on_net(o)).norm() < 1e-14);
      CHECK((on_net(-3 * normal) - pole_on_net(o)).norm() < 1e-14);
      CHECK(orientation_of(-normal).dip == Approx(o.dip));
      CHECK(orientation_of(2 * normal).dip_direction == Approx(o.dip_direction).margin(1e-12));
    }
}

TEST_CASE("a great circle joins the ends of the strike by way of the dip, a right angle from the pole") {
  const Orientation o{40 * degree, 120 * degree};
  const auto circle = great_circle_on_net(o, 181);
  REQUIRE(circle.size() == 181);
  CHECK((circle.front() - Eigen::Vector2d(std::sin(30 * degree), std::cos(30 * degree))).norm() < 1e-14);
  CHECK((circle.back() + circle.front()).norm() < 1e-14);
  const double middle =
      std::sqrt(2.) * std::sin(25 * degree); // of the line of dip, which plunges by 40 degrees
  CHECK((circle[90] - middle * Eigen::Vector2d(std::sin(120 * degree), std::cos(120 * degree))).norm() <
        1e-14);
  for (const Eigen::Vector2d& x : circle) {
    // Back from the net: sin of the plunge is 1 - r^2.
    const double sine = 1 - x.squaredNorm(), part = std::sqrt(2 - x.squaredNorm());
    CHECK(std::abs(Vec3(part * x.x(), part * x.y(), -sine).dot(normal_of_dip(o.dip, o.dip_direction))) <
          1e-14);
  }
}

TEST_CASE("equal areas of the hemisphere are equal areas of the net") {
  // Of directions that are even over the sphere, a part r^2 falls within r of the centre, at every azimuth alike.
  int within = 0, north = 0;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d x = on_net(random_rotation(7, static_cast<std::uint64_t>(i)).row(0));
    REQUIRE(x.norm() < 1 + 1e-12);
    within += x.norm() < 0.6 ? 1 : 0;
    north += x.y() > std::abs(x.x()) ? 1 : 0;
  }
  CHECK(within / double(count) == Approx(0.36).margin(4 * std::sqrt(0.36 * 0.64 / count)));
  CHECK(north / double(count) == Approx(0.25).margin(4 * std::sqrt(0.25 * 0.75 / count)));
}
