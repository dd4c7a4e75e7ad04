// A mesh whose tets do not all hang together is as many parts as it has sets that do.
#include "libgeom/assembly/tet_blocks.hpp"
#include "libgeom/mesh/boundary.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/mesh/parts.hpp"

#include <catch2/catch.hpp>

using namespace geom;

namespace {

// Boxes of 1 m side by side with a gap, as one mesh; tets of the boxes take turns.
TetMesh apart(int count) {
  TetMesh all;
  const TetMesh one = box_mesh({1, 1, 1}, {2, 2, 2}, 0.1);
  for (int i = 0; i < count; ++i)
    for (const Vec3& x : one.nodes)
      all.nodes.push_back(x + Vec3(1.5 * i, 0, 0));
  for (std::size_t t = 0; t < one.tets.size(); ++t)
    for (int i = 0; i < count; ++i) {
      Tet tet = one.tets[t];
      for (int& node : tet)
        node += i * static_cast<int>(one.nodes.size());
      all.tets.push_back(tet);
      all.region.push_back(i);
    }
  return all;
}

} // namespace

TEST_CASE("a mesh falls into its parts, each with all its tets, regions and named faces", "[parts]") {
  TetMesh mesh = apart(3);
  const std::vector<OuterFace> outer = outer_faces(mesh);
  mesh.named["top"] = faces_on_side(mesh, outer, "z+");
  mesh.named["end"] = faces_on_side(mesh, outer, "x+");
  CHECK(count_parts(mesh) == 3);
  const std::vector<TetMesh> all = parts(mesh);
  REQUIRE(all.size() == 3);
  for (int i = 0; i < 3; ++i) {
    INFO("part " << i);
    const TetMesh& part = all[i];
    CHECK_NOTHROW(validate(part, "part"));
    CHECK(volume(part) == Approx(1));
    CHECK(bounding_box(part).min.x() == Approx(1.5 * i));
    CHECK(std::count(part.region.begin(), part.region.end(), i) == static_cast<int>(part.tets.size()));
    const std::vector<OuterFace> faces = outer_faces(part);
    CHECK(part.named.at("top") == faces_on_side(part, faces, "z+"));
    CHECK(part.named.count("end") == (i == 2 ? 1 : 0));
  }
}

TEST_CASE("parts that share a single node hang together", "[parts]") {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  mesh.tets = {{0, 1, 2, 3}, {0, 5, 4, 6}};
  mesh.region = {0, 0};
  CHECK(count_parts(mesh) == 1);
  CHECK(parts(mesh).front().tets.size() == 2);
}

TEST_CASE("the tets of a mesh become blocks that share its inner faces and fill its volume", "[parts]") {
  const TetMesh mesh = box_mesh({1, 0.8, 1.2}, {3, 2, 3}, 0.15);
  const Assembly assembly = tet_blocks(mesh);
  REQUIRE(assembly.blocks.size() == mesh.tets.size());
  double sum = 0;
  for (const Polyhedron& block : assembly.blocks) {
    CHECK_NOTHROW(validate(block));
    sum += mass_properties(block).volume;
  }
  CHECK(sum == Approx(1 * 0.8 * 1.2));
  CHECK(shared_faces(assembly.blocks, 1e-9).size() == inner_faces(mesh).size());
}
