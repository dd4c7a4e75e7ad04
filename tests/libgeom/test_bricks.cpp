#include "libgeom/assembly/builders.hpp"
#include "tests/libgeom/assembly_laws.hpp"

#include <catch2/catch.hpp>

using namespace geom;

namespace {

BrickOptions wall() {
  BrickOptions o;
  o.size = {1.0, 0.1, 0.4};
  o.brick = {0.25, 0.1, 0.1};
  return o;
}

} // namespace

TEST_CASE("a running bond has n bricks in even courses and n + 1, two of them halves, in odd ones") {
  const Assembly a = bricks(wall());
  CHECK(a.blocks.size() == 4 + 5 + 4 + 5);
  CHECK(testing::total_volume(a) == Approx(0.04).epsilon(1e-14));
  CHECK(testing::loose_area(a, testing::box_surface(wall().size), 1e-9) < 1e-13);
}

TEST_CASE("each bed joint of a running bond is met by two half overlaps per brick") {
  // Head joints: 3 + 4 + 3 + 4. Bed joints: the 3 + 4 joints of two courses cut each of 3 beds into 8 pieces.
  CHECK(shared_faces(bricks(wall()).blocks, 1e-9).size() == 14 + 3 * 8);
}

TEST_CASE("each course is shifted against the one below") {
  BrickOptions o = wall();
  o.shift = 0.3;
  double expected = 0; // of the first head joint, in bricks
  const Assembly a = bricks(o);
  for (int course = 0; course < 4; ++course) {
    double first = 1e9;
    for (const Polyhedron& block : a.blocks)
      if (std::abs(bounding_box(block).min.z() - 0.1 * course) < 1e-12)
        first = std::min(first, bounding_box(block).max.x());
    CHECK(first == Approx((expected == 0 ? 1 : expected) * 0.25).epsilon(1e-13));
    expected = std::fmod(expected + 0.3, 1.0);
  }
}

TEST_CASE("bricks that do not fit are cut to the wall") {
  BrickOptions o;
  o.size = {1.1, 0.25, 0.35};
  o.brick = {0.25, 0.1, 0.1};
  o.origin = {5, 6, 7};
  const Assembly a = bricks(o);
  CHECK(testing::total_volume(a) == Approx(o.size.prod()).epsilon(1e-13));
  CHECK(testing::loose_area(a, testing::box_surface(o.size), 1e-9) < 1e-13);
  CHECK(bounding_box(a).min == o.origin);
  CHECK(bounding_box(a).max == Vec3(o.origin + o.size));
}

TEST_CASE("a shift of 0 or 1 is a stack bond") {
  BrickOptions o = wall();
  for (double shift : {0.0, 1.0}) {
    o.shift = shift;
    CHECK(bricks(o).blocks.size() == 16);
    CHECK(shared_faces(bricks(o).blocks, 1e-9).size() == 12 + 12);
  }
}
