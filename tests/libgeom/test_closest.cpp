// Nearest places and touching boxes beside CGAL's.
#include "libgeom/query/closest.hpp"

#include "libgeom/core/random.hpp"
#include "libgeom/query/box_pairs.hpp"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/squared_distance_3.h>

#include <algorithm>
#include <catch2/catch.hpp>

using geom::Vec3;

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;

Point point(const Vec3& x) {
  return {x.x(), x.y(), x.z()};
}

Vec3 draw(std::uint64_t id, std::uint64_t first) {
  return {geom::uniform(3, id, first), geom::uniform(3, id, first + 1), geom::uniform(3, id, first + 2)};
}

} // namespace

TEST_CASE("the nearest place on a triangle is as near as CGAL's", "[closest]") {
  int inside = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Vec3 x = 2 * draw(i, 0) - Vec3::Constant(0.5), a = draw(i, 3), b = draw(i, 6), c = draw(i, 9);
    const geom::PlaceOnTriangle at = geom::nearest_on_triangle(x, a, b, c);
    CHECK(at.weights.minCoeff() >= 0);
    CHECK(at.weights.sum() == Approx(1).epsilon(1e-12));
    const Vec3 place = at.weights[0] * a + at.weights[1] * b + at.weights[2] * c;
    const double exact = CGAL::squared_distance(point(x), Kernel::Triangle_3(point(a), point(b), point(c)));
    CHECK((x - place).squaredNorm() == Approx(exact).margin(1e-14).epsilon(1e-9));
    inside += at.inside ? 1 : 0;
  }
  CHECK(inside > 50);
  CHECK(inside < 1950);
}

TEST_CASE("the nearest places of two segments are as near as CGAL's", "[closest]") {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Vec3 a0 = draw(i, 0), a1 = draw(i, 3), b0 = draw(i, 6), b1 = draw(i, 9);
    const auto at = geom::nearest_on_segments(a0, a1, b0, b1);
    const double exact = CGAL::squared_distance(Kernel::Segment_3(point(a0), point(a1)),
                                                Kernel::Segment_3(point(b0), point(b1)));
    CHECK((a0 + at.s * (a1 - a0) - b0 - at.t * (b1 - b0)).squaredNorm() ==
          Approx(exact).margin(1e-14).epsilon(1e-9));
  }
}

TEST_CASE("the grid finds the pairs of boxes that CGAL finds", "[closest][grid]") {
  const std::size_t n = GENERATE(2, 50, 1000);
  std::vector<geom::Box> boxes;
  using Box = CGAL::Box_intersection_d::Box_d<double, 3, CGAL::Box_intersection_d::ID_EXPLICIT>;
  std::vector<Box> theirs;
  for (std::uint64_t i = 0; i < n; ++i) {
    geom::Box box;
    box.extend(draw(i, 0));
    // A few are many times larger than the others.
    box.extend(box.min + (i % 50 == 0 ? 0.8 : 0.1) * draw(i, 3));
    boxes.push_back(box);
    theirs.emplace_back(
        CGAL::Bbox_3(box.min.x(), box.min.y(), box.min.z(), box.max.x(), box.max.y(), box.max.z()));
  }
  const std::size_t first = theirs.front().id(); // they are put in another order on the way
  std::vector<std::pair<int, int>> expected;
  CGAL::box_self_intersection_d(theirs.begin(), theirs.end(), [&](const Box& a, const Box& b) {
    const int i = static_cast<int>(a.id() - first), j = static_cast<int>(b.id() - first);
    expected.emplace_back(std::min(i, j), std::max(i, j));
  });
  std::sort(expected.begin(), expected.end());
  CHECK(geom::touching_pairs(boxes) == expected);
}
