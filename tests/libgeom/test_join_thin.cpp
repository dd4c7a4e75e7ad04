// Thin blocks that joint sets leave, joined to their neighbours.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/assembly/join_thin.hpp"
#include "tests/libgeom/assembly_laws.hpp"

#include <catch2/catch.hpp>

using namespace geom;
using testing::total_volume;

TEST_CASE("the two halves of a cut block are the block again", "[join_thin]") {
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(1, 2, 3), Vec3(1, 1, 1)}) {
    const Assembly halves = cut_by_plane(grid({1, 2, 3}, {1, 1, 1}), Plane::through({0.5, 1, 1.5}, normal));
    REQUIRE(halves.blocks.size() == 2);
    const SharedFace s = shared_faces(halves.blocks, 1e-9).at(0);
    const auto whole = united(halves.blocks[0], s.face_a, halves.blocks[1], s.face_b);
    REQUIRE(whole);
    CHECK(whole->vertices.size() == 8);
    CHECK(whole->faces.size() == 6);
    CHECK(mass_properties(*whole).volume == Approx(6));
  }
}

TEST_CASE("blocks that are not convex together stay two", "[join_thin]") {
  const Assembly step = merged({grid({1, 1, 1}, {1, 1, 1}), grid({1, 1, 2}, {1, 1, 1}, {1, 0, 0})});
  const SharedFace s = shared_faces(step.blocks, 1e-9).at(0);
  CHECK(!united(step.blocks[0], s.face_a, step.blocks[1], s.face_b));
}

TEST_CASE("splinters of joint sets are gone, the volume stays and the blocks fit", "[join_thin]") {
  const Vec3 size(12, 8, 10);
  const std::vector<JointSet> sets{{0.6, 1.57, 2, 0.2, 0, 0, "bedding"},
                                   {1.2, 4.7, 2, 0.4, 0.1, 0.1, "cross"},
                                   {1.57, 0, 2.5, 0.3, 0, 0, "side"}};
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const Assembly rock = cut_by_joints(grid(size, {1, 1, 1}), sets, seed);
    const double smallest = 0.3;
    const JoinedThin joined = join_thin(rock, smallest);
    CHECK(static_cast<std::int64_t>(joined.assembly.blocks.size()) ==
          static_cast<std::int64_t>(rock.blocks.size()) - joined.united);
    CHECK(joined.united > 0);
    CHECK(total_volume(joined.assembly) == Approx(size.prod()).epsilon(1e-9));
    CHECK(testing::loose_area(joined.assembly, testing::box_surface(size), 1e-6) < 1e-3);
    std::int64_t thin = 0;
    for (const Polyhedron& block : joined.assembly.blocks) {
      CHECK_NOTHROW(validate(block));
      thin += thickness(block) < smallest ? 1 : 0;
    }
    CHECK(thin <= joined.glued);
    const auto names = cut_names(joined.assembly);
    CHECK(names == std::vector<std::string>{"bedding", "cross", "side"});
  }
}

TEST_CASE("a thin block that fits no neighbour is glued by its largest face", "[join_thin]") {
  // A tile over the seam of two bricks.
  const Assembly tile = merged({grid({2, 1, 1}, {2, 1, 1}), grid({2, 1, 0.05}, {1, 1, 1}, {0, 0, 1})});
  const JoinedThin joined = join_thin(tile, 0.1);
  CHECK(joined.united == 0);
  CHECK(joined.glued == 1);
  CHECK(joined.assembly.blocks.size() == 3);
}

TEST_CASE("no block is united across the outline of an excavation", "[join_thin]") {
  PlaneCutOptions outline;
  outline.glued = true;
  const Plane floor = Plane::through({0, 0, 4}, {0, 0, 1});
  const Assembly ground = cut_by_plane(grid({12, 4, 8}, {1, 1, 1}), floor, outline);
  const std::vector<JointSet> sets{{0.2, 1.57, 1.5, 0.2, 0, 0, "bedding"},
                                   {1.3, 1.57, 2, 0.2, 0, 0, "steep"}};
  const JoinedThin joined = join_thin(cut_by_joints(ground, sets, 3), 0.3);
  CHECK(joined.united > 0);
  for (const Polyhedron& block : joined.assembly.blocks) {
    const Box box = bounding_box(block);
    CHECK((box.min.z() > 4 - 1e-9 || box.max.z() < 4 + 1e-9));
  }
}

TEST_CASE("a splinter at the outline is glued on its own side, and once", "[join_thin]") {
  // Bricks, a tile over their seam, and the ground above the tile that is to be removed.
  PlaneCutOptions seam, outline, bed;
  outline.glued = true;
  seam.name = "seam", outline.name = "outline", bed.name = "bed";
  Assembly bricks =
      cut_by_plane(grid({2, 1, 3}, {1, 1, 1}), Plane::through({0, 0, 1.05}, {0, 0, 1}), outline);
  bricks = cut_by_plane(bricks, Plane::through({0, 0, 1}, {0, 0, 1}), bed);
  seam.inside = Box{{0, 0, 0}, {2, 1, 1}};
  bricks = cut_by_plane(bricks, Plane::through({1, 0, 0}, {1, 0, 0}), seam);
  const auto glued_beds = [](const Assembly& a) {
    int count = 0;
    for (const SharedFace& s : shared_faces(a.blocks, 1e-9)) {
      const PolyhedronFace& face = a.blocks[s.block_a].faces[s.face_a];
      count += face.cut == "bed" && face.glued ? 1 : 0;
    }
    return count;
  };
  const JoinedThin once = join_thin(bricks, 0.1);
  CHECK(once.assembly.blocks.size() == 4);
  CHECK(once.glued == 1);
  CHECK(glued_beds(once.assembly) == 1);
  const JoinedThin twice = join_thin(once.assembly, 0.1);
  CHECK(twice.glued == 0);
  CHECK(glued_beds(twice.assembly) == 1);
}
