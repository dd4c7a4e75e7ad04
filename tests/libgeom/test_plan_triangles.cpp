// Points as a surface over their plan.
#include "libgeom/core/random.hpp"
#include "libgeom/mesh/plan_triangles.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

using namespace geom;
using Catch::Matchers::Contains;
using testing::refusal;

TEST_CASE("triangles of points cover their hull once and hold no other point within their circle") {
  std::vector<Vec3> points{{0, 0, 0}, {10, 0, 1}, {10, 8, 2}, {0, 8, 3}};
  for (std::uint64_t i = 0; i < 60; ++i)
    points.emplace_back(10 * uniform(3, i, 0), 8 * uniform(3, i, 1), uniform(3, i, 2));
  const Vec3 far(4e5, 5e6, 100); // survey coordinates
  for (Vec3& x : points)
    x += far;
  const Surface surface = plan_triangles(points, "points");
  CHECK(surface.points.size() == points.size());
  double area = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto x = surface.corners(t);
    const double twice = (x[1] - x[0]).cross(x[2] - x[0]).z();
    REQUIRE(twice > 0);
    area += 0.5 * twice;
    const Eigen::Vector2d a = (x[1] - x[0]).head<2>(), b = (x[2] - x[0]).head<2>();
    const Eigen::Vector2d middle = Eigen::Vector2d(b.y() * a.squaredNorm() - a.y() * b.squaredNorm(),
                                                   a.x() * b.squaredNorm() - b.x() * a.squaredNorm()) /
                                   (2 * twice);
    for (const Vec3& other : points)
      CHECK(((other - x[0]).head<2>() - middle).norm() > middle.norm() - 1e-6);
  }
  CHECK(area == Approx(80));
}

TEST_CASE("points that span no surface are refused", "[input]") {
  CHECK_THAT(refusal([] {
               plan_triangles({{0, 0, 0}, {1, 0, 0}}, "points");
             }),
             Contains("points = 2 points"));
  CHECK_THAT(refusal([] {
               plan_triangles({{0, 0, 0}, {1, 1, 0}, {2, 2, 9}}, "points");
             }),
             Contains("on one line"));
  CHECK_THAT(refusal([] {
               plan_triangles({{0, 0, 0}, {1, 1, 0}, {0, 0, 9}}, "points");
             }),
             Contains("points[3]") && Contains("point 1 is there already"));
}
