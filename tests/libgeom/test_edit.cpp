#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/core/error.hpp"
#include "tests/libgeom/assembly_laws.hpp"

#include <catch2/catch.hpp>

using namespace geom;
using Catch::Matchers::Contains;

TEST_CASE("a plane splits the blocks it crosses and no others") {
  const Assembly a = grid({4, 1, 1}, {4, 1, 1});
  const Assembly level = cut_by_plane(a, Plane::through({0, 0, 0.3}, {0, 0, 1}));
  CHECK(level.blocks.size() == 8);
  CHECK(mass_properties(level.blocks[0]).volume == Approx(0.3).epsilon(1e-14)); // the lower part comes first
  CHECK(cut_by_plane(a, Plane::through({1.5, 0, 0}, {1, 0, 0})).blocks.size() == 5);
  CHECK(cut_by_plane(a, Plane::through({2, 0, 0}, {1, 0, 0})).blocks.size() == 4); // between two blocks
  CHECK(cut_by_plane(a, Plane::through({9, 0, 0}, {1, 0, 0})).blocks.size() == 4);
}

TEST_CASE("a plane can be kept to the blocks in a box") {
  PlaneCutOptions options;
  options.inside = Box{{0, 0, 0}, {2, 1, 1}};
  const Assembly a =
      cut_by_plane(grid({4, 1, 1}, {4, 1, 1}), Plane::through({0, 0, 0.3}, {0, 0, 1}), options);
  CHECK(a.blocks.size() == 6);
  CHECK(testing::total_volume(a) == Approx(4).epsilon(1e-14));
}

TEST_CASE("a plane's normal may have any length") {
  const Assembly a = cut_by_plane(grid({1, 1, 1}, {1, 1, 1}), {{0, 0, 10}, 3});
  REQUIRE(a.blocks.size() == 2);
  CHECK(mass_properties(a.blocks[0]).volume == Approx(0.3).epsilon(1e-14));
}

TEST_CASE("with a clearance the plane is shifted clear of a block's vertices") {
  PlaneCutOptions options;
  options.clearance = 0.05;
  const auto parts = [&](double z) {
    return cut_by_plane(grid({1, 1, 1}, {1, 1, 1}), {Vec3::UnitZ(), z}, options).blocks;
  };
  CHECK(parts(0.01).size() == 1); // nearest: onto the face, which only touches
  REQUIRE(parts(0.04).size() == 2);
  CHECK(mass_properties(parts(0.04)[0]).volume == Approx(0.05).epsilon(1e-13));
}

TEST_CASE("moving and turning an assembly keeps its volume and what it shares") {
  const Assembly a = grid({1, 2, 3}, {2, 3, 4});
  const Assembly b = translated(rotated(a, {1, 1, 0}, 0.8, {5, 5, 5}), {1, 2, 3});
  CHECK(testing::total_volume(b) == Approx(6).epsilon(1e-13));
  CHECK(shared_faces(b.blocks, 1e-9).size() == shared_faces(a.blocks, 1e-9).size());
}

TEST_CASE("a quarter turn about z takes x to y") {
  const Assembly a = rotated(grid({2, 1, 1}, {1, 1, 1}), {0, 0, 3}, 1.5707963267948966, {1, 0, 0});
  CHECK((bounding_box(a).min - Vec3(0, -1, 0)).norm() < 1e-15);
  CHECK((bounding_box(a).max - Vec3(1, 1, 1)).norm() < 1e-15);
}

TEST_CASE("merged assemblies share the faces in which they touch") {
  const Assembly a = merged({grid({1, 1, 1}, {2, 2, 2}), grid({1, 1, 1}, {3, 3, 3}, {1, 0, 0})});
  CHECK(a.blocks.size() == 8 + 27);
  // 2 x 2 against 3 x 3 faces: lines at 1/2 and at 1/3, 2/3 cut the common square into 4 x 4 pieces.
  CHECK(shared_faces(a.blocks, 1e-9).size() == 12 + 54 + 16);
}

TEST_CASE("only blocks that reach into the crossing box are cut") {
  PlaneCutOptions options;
  options.crossing = Box{{0.5 - 1e-6, 0, 0}, {0.5 + 1e-6, 0.9, 1}};
  // 3 x 3 blocks; the line x = 0.5, y <= 0.9 runs through the middle column, all three rows of it.
  CHECK(cut_by_plane(grid({1, 1, 1}, {3, 3, 1}), {Vec3::UnitX(), 0.5}, options).blocks.size() == 12);
  options.crossing->max.y() = 1.0 / 3; // up to the face between the first and the second row
  CHECK(cut_by_plane(grid({1, 1, 1}, {3, 3, 1}), {Vec3::UnitX(), 0.5}, options).blocks.size() == 10);
  // A block that the box only passes by, though the boxes around both meet.
  const Assembly turned = rotated(grid({1, 1, 1}, {1, 1, 1}), Vec3::UnitZ(), 0.7853981633974483);
  options.crossing = Box{{0.5, 0, 0}, {0.7, 0.2, 1}};
  CHECK(cut_by_plane(turned, {Vec3::UnitX(), 0.1}, options).blocks.size() == 1);
  options.crossing = Box{{0, 0.2, 0}, {0.1, 0.3, 1}};
  CHECK(cut_by_plane(turned, {Vec3::UnitX(), 0.1}, options).blocks.size() == 2);
}

TEST_CASE("blocks are kept by their centroids") {
  const Assembly a = kept(grid({4, 4, 1}, {4, 4, 1}), {{1, 1, 0}, {3, 3, 1}});
  CHECK(a.blocks.size() == 4);
  CHECK((bounding_box(a).min - Vec3(1, 1, 0)).norm() == 0);
  CHECK_THROWS_AS(kept(a, {{10, 10, 10}, {11, 11, 11}}), geom::InputError);
}
