#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/error.hpp"
#include "tests/libgeom/random_shapes.hpp"

#include <catch2/catch.hpp>
#include <memory>

using namespace geom;
using Catch::Matchers::Contains;
using testing::Draws;

TEST_CASE("the hull of a box's corners, also with points inside, on faces and on edges, is the box") {
  const Polyhedron box = make_box({1, 2, 3}, {2, 4, 6});
  Draws draws{31, 1};
  std::vector<Vec3> points = box.vertices;
  for (int i = 0; i < 100; ++i) {
    const Vec3 x = draws.point(bounding_box(box));
    points.push_back(x);
    points.push_back({1, x.y(), x.z()});
    points.push_back({x.x(), 4, x.z()});
    points.push_back({x.x(), 2, 6});
  }
  for (int turned = 0; turned < 2; ++turned) {
    const Polyhedron hull = convex_hull(points);
    CHECK(hull.vertices.size() == 8);
    CHECK(hull.faces.size() == 6);
    CHECK(mass_properties(hull).volume == Approx(6).epsilon(1e-13));
    const Mat3 q = Eigen::AngleAxisd(1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    for (Vec3& x : points)
      x = q * x; // now the points lie on the faces to rounding only
  }
}

TEST_CASE("the hull of a random block's vertices is that block") {
  for (std::uint64_t i = 0; i < 200; ++i) {
    Draws draws{32, i};
    const Polyhedron p = testing::random_block(draws, 8);
    const Polyhedron hull = convex_hull(p.vertices);
    CHECK(hull.vertices.size() == p.vertices.size());
    CHECK(hull.faces.size() == p.faces.size());
    CHECK(mass_properties(hull).volume == Approx(mass_properties(p).volume).epsilon(1e-12));
  }
}

TEST_CASE("the hull of both parts of a cut is the block again") {
  for (std::uint64_t i = 0; i < 100; ++i) {
    Draws draws{33, i};
    const Polyhedron p = testing::random_block(draws);
    const Cut halves = cut(p, Plane::through(draws.point(bounding_box(p)), draws.direction()));
    std::vector<Vec3> points;
    for (const auto& part : {halves.above, halves.below})
      if (part)
        points.insert(points.end(), part->shape.vertices.begin(), part->shape.vertices.end());
    CHECK(mass_properties(convex_hull(points)).volume == Approx(mass_properties(p).volume).epsilon(1e-12));
  }
}

TEST_CASE("the hull of points is the same wherever memory lies") {
  Draws draws{35, 1};
  std::vector<Vec3> points;
  const Mat3 turned = Eigen::AngleAxisd(1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (int i = 0; i < 12; ++i) // a prism, with the points of its faces in one plane to rounding
    points.push_back(turned * Vec3(std::cos(i * M_PI / 6), std::sin(i * M_PI / 6), i % 2));
  const Polyhedron first = convex_hull(points);
  for (int attempt = 0; attempt < 50; ++attempt) {
    std::vector<std::unique_ptr<char[]>> blocks; // leave holes for the next hull
    for (int i = 0; i < 200; ++i)
      blocks.push_back(std::make_unique<char[]>(16 + static_cast<std::size_t>(draws.uniform(0, 200))));
    while (blocks.size() > 20) {
      std::swap(blocks[static_cast<std::size_t>(draws.uniform(0, static_cast<double>(blocks.size())))],
                blocks.back());
      blocks.pop_back();
    }
    const Polyhedron again = convex_hull(points);
    REQUIRE(again.vertices == first.vertices);
    REQUIRE(again.faces.size() == first.faces.size());
    for (std::size_t f = 0; f < first.faces.size(); ++f)
      REQUIRE(again.faces[f].loop == first.faces[f].loop);
  }
}

TEST_CASE("every point of a random cloud lies in its hull, and every corner is a point") {
  Draws draws{34, 1};
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i)
    points.push_back(draws.direction() * std::cbrt(draws.uniform(0, 1)));
  const Polyhedron hull = convex_hull(points);
  CHECK_NOTHROW(validate(hull));
  for (int f = 0; f < static_cast<int>(hull.faces.size()); ++f) {
    const Plane plane = Plane::through(face_centroid(hull, f), face_normal(hull, f));
    for (const Vec3& x : points)
      CHECK(plane.level(x) < 1e-12);
  }
  for (const Vec3& v : hull.vertices)
    CHECK(std::count(points.begin(), points.end(), v) == 1);
}

TEST_CASE("a hull needs four finite points that are not in one plane") {
  CHECK_THROWS_WITH(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
                    Contains("points = 3 points") && Contains("at least 4"));
  CHECK_THROWS_WITH(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}),
                    Contains("not in one plane"));
  CHECK_THROWS_WITH(convex_hull({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}), Contains("not in one plane"));
  CHECK_THROWS_WITH(convex_hull({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}), Contains("not in one plane"));
  CHECK_THROWS_WITH(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}}),
                    Contains("points[4] = {0, 0, nan}: must be three finite numbers"));
}
