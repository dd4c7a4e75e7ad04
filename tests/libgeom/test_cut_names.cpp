// Faces keep the name of the joint set or cut that made them.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"

#include <catch2/catch.hpp>

using namespace geom;

namespace {

// Area of the faces of one name, both sides, m2.
double area_of(const Assembly& assembly, const std::string& name) {
  double area = 0;
  for (const Polyhedron& block : assembly.blocks)
    for (std::size_t f = 0; f < block.faces.size(); ++f)
      if (block.faces[f].cut == name)
        area += face_area(block, static_cast<int>(f));
  return area;
}

Assembly bedded_box() {
  JointSet bedding;
  bedding.spacing = 0.5;
  bedding.name = "bedding";
  return cut_by_joints(grid({2, 1, 1}, {1, 1, 1}), {bedding});
}

} // namespace

TEST_CASE("a joint set names both sides of the faces it makes and no others") {
  const Assembly bedded = bedded_box();
  REQUIRE(bedded.blocks.size() == 2);
  CHECK(cut_names(bedded) == std::vector<std::string>{"bedding"});
  CHECK(area_of(bedded, "bedding") == Approx(2 * 2.0).epsilon(1e-12));
  CHECK(area_of(bedded, "") == Approx(10.0).epsilon(1e-12)); // the outside of the box
}

TEST_CASE("names stay through further cuts, keeping, moving, turning and merging") {
  PlaneCutOptions options;
  options.name = "outline";
  options.glued = true;
  Assembly a = cut_by_plane(bedded_box(), Plane::through({0.7, 0, 0}, {1, 0, 0}), options);
  REQUIRE(a.blocks.size() == 4);
  CHECK(area_of(a, "bedding") == Approx(4).epsilon(1e-12));
  CHECK(area_of(a, "outline") == Approx(2).epsilon(1e-12));
  for (const Polyhedron& block : a.blocks)
    for (const PolyhedronFace& face : block.faces)
      CHECK(face.glued == (face.cut == "outline"));
  a = merged({translated(rotated(a, {1, 2, 3}, 0.4), {5, 6, 7}), bedded_box()});
  CHECK(area_of(a, "bedding") == Approx(8).epsilon(1e-12));
  CHECK(cut_names(a) == std::vector<std::string>{"bedding", "outline"});
  CHECK(cut_names(kept(a, Box{{-1, -1, -1}, {3, 2, 2}})) == std::vector<std::string>{"bedding"});
}

TEST_CASE("a cut along a face that is there leaves its name") {
  PlaneCutOptions options;
  options.name = "outline";
  const Assembly a = cut_by_plane(bedded_box(), Plane::through({0, 0, 0.5}, {0, 0, 1}), options);
  CHECK(a.blocks.size() == 2);
  CHECK(cut_names(a) == std::vector<std::string>{"bedding"});
}
