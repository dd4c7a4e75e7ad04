#include "libgeom/mesh/star_mesh.hpp"
#include "tests/libgeom/random_shapes.hpp"

#include <catch2/catch.hpp>

using namespace geom;

TEST_CASE("the star mesh fills the block with positive tets, one per edge of each face") {
  testing::Draws draws{3, 1};
  for (int i = 0; i < 200; ++i) {
    const Polyhedron p = testing::random_block(draws);
    const BlockMesh mesh = star_mesh(p);
    CHECK(mesh.nodes.size() == p.vertices.size() + p.faces.size() + 1);
    CHECK(mesh.tets.size() == 2 * edges(p).size());
    double sum = 0;
    for (const Tet& t : mesh.tets) {
      const Vec3 &x0 = mesh.nodes[t[0]], &x1 = mesh.nodes[t[1]], &x2 = mesh.nodes[t[2]],
                 &x3 = mesh.nodes[t[3]];
      const double v = (x1 - x0).dot((x2 - x0).cross(x3 - x0)) / 6;
      CHECK(v > 0);
      sum += v;
    }
    CHECK(sum == Approx(mass_properties(p).volume).epsilon(1e-13));
  }
}

TEST_CASE("the fans of the star mesh tile the faces and look outward") {
  testing::Draws draws{4, 1};
  for (int i = 0; i < 200; ++i) {
    const Polyhedron p = testing::random_block(draws);
    const BlockMesh mesh = star_mesh(p);
    REQUIRE(mesh.fans.size() == p.faces.size());
    for (int f = 0; f < static_cast<int>(p.faces.size()); ++f) {
      double area = 0;
      for (const Triangle& t : mesh.fans[f])
        area += 0.5 * (mesh.nodes[t[1]] - mesh.nodes[t[0]])
                          .cross(mesh.nodes[t[2]] - mesh.nodes[t[0]])
                          .dot(face_normal(p, f));
      CHECK(area == Approx(face_area(p, f)).epsilon(1e-13));
    }
  }
}

TEST_CASE("the star mesh's inner nodes are area and volume centroids") {
  const Polyhedron p = make_box({0, 0, 0}, {2, 4, 6});
  const BlockMesh mesh = star_mesh(p);
  CHECK((mesh.nodes.back() - Vec3(1, 2, 3)).norm() < 1e-15);
  CHECK((mesh.nodes[8] - Vec3(0, 2, 3)).norm() < 1e-15); // face 0 is x-
}
