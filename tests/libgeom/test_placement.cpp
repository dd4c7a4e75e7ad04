// Where units start: attitudes and drop grids.
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/mesh/parts.hpp"
#include "libgeom/mesh/triangle_distance.hpp"
#include "libgeom/meshing/solid_mesh.hpp"
#include "libgeom/placement/armour_layer.hpp"
#include "libgeom/placement/drop_grid.hpp"
#include "libgeom/placement/pile_measures.hpp"
#include "libgeom/placement/rest.hpp"
#include "libgeom/placement/walls.hpp"
#include "libgeom/solid/armour_units.hpp"
#include "tests/libgeom/piles.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace geom;
using namespace testing;
using Catch::Matchers::Contains;

TEST_CASE("the distance of two triangles is that of their nearest points") {
  const TrianglePoints flat{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  CHECK(distance(flat, {Vec3(1, 1, 2), Vec3(2, 1, 3), Vec3(1, 2, 3)}) == Approx(2));     // corner over face
  CHECK(distance(flat, {Vec3(-3, 0, 4), Vec3(-9, 0, 4), Vec3(-3, 9, 9)}) == Approx(5));  // corner, edge
  CHECK(distance(flat, {Vec3(1, -2, 1), Vec3(3, -2, -1), Vec3(2, -9, 0)}) == Approx(2)); // edge, edge
  CHECK(distance(flat, {Vec3(1, 1, -1), Vec3(1, 1, 5), Vec3(1, 9, 5)}) == 0);            // cut through
  CHECK(distance(flat, {Vec3(1, 1, 0), Vec3(1.5, 1, 0), Vec3(1, 1.5, 0)}) == Approx(0).margin(1e-14));
}

TEST_CASE("the distance of two boxes is looked for up to a limit") {
  const TetMesh cube = box_mesh({1, 1, 1}, {2, 2, 2});
  const Surface one = surface_of(cube), other = surface_of(moved(cube, {1.3, 1.4, 0.2}));
  CHECK(distance(one, other, 10) == Approx(0.5));
  CHECK(distance(one, other, 0.4) == 0.4);
  CHECK(distance(one, surface_of(moved(cube, {0.9, 0.9, 0.9})), 1) == 0);
}

TEST_CASE("random attitudes are uniform over all rotations") {
  // Entries of a uniform rotation have mean 0 and mean square 1/3; standard deviations of the means below.
  constexpr int n = 4000;
  Mat3 mean = Mat3::Zero(), square = Mat3::Zero();
  for (int i = 0; i < n; ++i) {
    const Mat3 r = random_rotation(7, i);
    REQUIRE((r * r.transpose() - Mat3::Identity()).norm() < 1e-12);
    REQUIRE(r.determinant() > 0);
    mean += r / n;
    square += r.cwiseProduct(r) / n;
  }
  CHECK(mean.cwiseAbs().maxCoeff() < 4 * std::sqrt(1. / 3 / n));
  CHECK((square.array() - 1. / 3).abs().maxCoeff() < 4 * std::sqrt((1. / 5 - 1. / 9) / n));
}

TEST_CASE("the best fit gives back a rigid motion") {
  const Pose motion{random_rotation(3, 1), {5, -2, 9}};
  const std::vector<Vec3>& points = accropode_mesh().nodes;
  std::vector<Vec3> places;
  std::vector<double> weights;
  for (std::size_t i = 0; i < points.size(); ++i) {
    places.push_back(motion(points[i]));
    weights.push_back(1 + 0.5 * std::sin(static_cast<double>(i)));
  }
  const Pose found = best_fit(points, places, weights);
  CHECK((found.rotation - motion.rotation).norm() < 1e-12);
  CHECK((found.translation - motion.translation).norm() < 1e-12);
}

TEST_CASE("a scaled pile has all its lengths scaled") {
  const Pile pile = drop_grid(accropode_mesh(), 3, slope_ground(0.5));
  const Pile large = scaled(pile, 1.5);
  const auto small_units = meshes(pile), units = meshes(large);
  for (std::size_t i = 0; i < units.size(); ++i)
    for (std::size_t n = 0; n < units[i].nodes.size(); ++n)
      REQUIRE((units[i].nodes[n] - 1.5 * small_units[i].nodes[n]).norm() < 1e-12);
  Box all;
  for (const TetMesh& unit : units)
    for (const Vec3& x : unit.nodes)
      all.extend(x);
  CHECK((bounding_box(large).min - all.min).norm() < 1e-12);
  CHECK((bounding_box(large).max - all.max).norm() < 1e-12);
  CHECK(nominal_diameter(large) == Approx(1.5 * nominal_diameter(pile)));
  CHECK(large.height == Approx(1.5 * pile.height));
}

TEST_CASE("units of a drop grid are clear of each other whatever their attitude") {
  const Pile pile = drop_grid(accropode_mesh(), 30, slope_ground(1 / 1.5), {0.2, {}, 2, 5});
  REQUIRE(pile.poses.size() == 30);
  const double diameter = 2 * bounding_radius(pile.unit);
  for (std::size_t i = 0; i < pile.poses.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      REQUIRE((pile.poses[i].translation - pile.poses[j].translation).norm() >= diameter + 0.2 - 1e-9);
}

TEST_CASE("the lowest layer of a drop grid hangs one gap above the ground") {
  for (const double gradient : {0., 1 / 1.5}) {
    const Pile pile = drop_grid(accropode_mesh(), 20, slope_ground(gradient), {0.3, {}, 1, 2});
    for (const TetMesh& unit : meshes(pile)) {
      double least = 1e9; // along z
      for (const Vec3& x : unit.nodes)
        least = std::min(least, x.z() - gradient * x.x());
      REQUIRE(least == Approx(0.3).epsilon(1e-9));
    }
  }
}

TEST_CASE("a drop grid starts at the toe and has its lowest row first") {
  const Pile up = drop_grid(accropode_mesh(), 20, slope_ground(0.5), {{}, {}, 1, 2});
  const Pile down = drop_grid(accropode_mesh(), 20, slope_ground(-0.5), {{}, {}, 1, 2});
  for (const Pile* pile : {&up, &down})
    CHECK(pile->poses.front().translation.z() < pile->poses.back().translation.z() - 1);
}

TEST_CASE("another seed turns the units, not their grid") {
  const Pile a = drop_grid(accropode_mesh(), 6, slope_ground(0.5)),
             b = drop_grid(accropode_mesh(), 6, slope_ground(0.5), {{}, {}, 0, 9}),
             again = drop_grid(accropode_mesh(), 6, slope_ground(0.5));
  for (int i = 0; i < 6; ++i) {
    CHECK((a.poses[i].rotation - b.poses[i].rotation).norm() > 1e-3);
    CHECK((a.poses[i].translation - b.poses[i].translation).head<2>().norm() == 0);
    CHECK(a.poses[i].rotation == again.poses[i].rotation);
    CHECK(a.poses[i].translation == again.poses[i].translation);
  }
}

TEST_CASE("a drop that cannot be made is refused") {
  const Ground ground = slope_ground(0.5);
  const auto drop = [&](int count, const DropOptions& options) {
    return refusal([&] { drop_grid(accropode_mesh(), count, ground, options); });
  };
  CHECK_THAT(drop(0, {}), Contains("count = 0: must be at least 1"));
  CHECK_THAT(drop(5, {-0.1, {}, 0, 1}), Contains("gap = -0.1: must be finite and > 0 m"));
  CHECK_THAT(drop(5, {0.1, {}, 21, 1}), Contains("layers = 21: must be from 1 to 20"));
  const PlanBox beside{{50, 0}, {60, 5}}, partly{{36, -5}, {60, 5}}, narrow{{5, 0}, {6, 5}},
      upside{{5, 5}, {6, 0}};
  CHECK_THAT(drop(5, {0.1, beside, 0, 1}), Contains("region = {50, 0} to {60, 5}: must be over the ground"));
  CHECK_THAT(drop(5, {0.1, partly, 0, 1}),
             Contains("beside the ground, whose plan is from {0, -10} to {40, 10}"));
  CHECK_THAT(drop(5, {0.1, narrow, 0, 1}), Contains("region = 1 m by 5 m: must be at least"));
  CHECK_THAT(drop(5, {0.1, upside, 0, 1}), Contains("min below max"));
  CHECK_THAT(drop(1000000, {}), Contains("count = 1000000: must be at most"));
  CHECK_THAT(drop(2000, {0.1, {}, 1, 1}), Contains("in 1 layer;"));
}

TEST_CASE("a ground without a face that looks up is refused") {
  Surface wall;
  wall.points = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  wall.triangles = {{0, 1, 2}};
  CHECK_THAT(refusal([&] { Ground ground(wall); }), Contains("no face that looks up"));
}
