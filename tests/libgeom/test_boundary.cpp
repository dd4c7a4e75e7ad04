// Faces of tet meshes: what closes, what is shared, where the outside turns.
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/boundary.hpp"
#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <set>

using namespace geom;

namespace {

const TetMesh brick = box_mesh({1, 2, 3}, {3, 4, 5}, 0.15, 7);

} // namespace

TEST_CASE("every face of every tet is either outside or between two tets") {
  const auto outer = outer_faces(brick);
  const auto inner = inner_faces(brick);
  CHECK(outer.size() == 2 * 2 * (3 * 4 + 4 * 5 + 5 * 3)); // two triangles on each cell's outer face
  CHECK(outer.size() + 2 * inner.size() == 4 * brick.tets.size());
  std::set<std::array<int, 2>> met; // tet, face
  for (const OuterFace& f : outer)
    CHECK(met.insert({f.tet, f.face}).second);
  for (const InnerFace& f : inner)
    for (std::size_t s = 0; s < 2; ++s)
      CHECK(met.insert({f.tets[s], f.faces[s]}).second);
}

TEST_CASE("neighbours are mutual and share three nodes, none of which is the corner opposite to the face") {
  const std::vector<int> other = face_neighbours(brick.tets, brick.nodes.size());
  REQUIRE(other.size() == 4 * brick.tets.size());
  bool mutual = true, shared = true;
  for (std::size_t i = 0; i < other.size(); ++i) {
    if (other[i] < 0)
      continue;
    mutual = mutual && other[other[i]] == static_cast<int>(i);
    const Tet &a = brick.tets[i / 4], &b = brick.tets[other[i] / 4];
    for (std::size_t c = 0; c < 4; ++c)
      shared = shared && (std::count(b.begin(), b.end(), a[c]) == 1) == (c != i % 4);
  }
  CHECK(mutual);
  CHECK(shared);
}

TEST_CASE("outer faces point outward: the divergence theorem gives the volume") {
  double flux = 0; // of x over the outside, 3 V
  Vec3 sum = Vec3::Zero();
  for (const OuterFace& f : outer_faces(brick)) {
    const Vec3 &a = brick.nodes[f.nodes[0]], &b = brick.nodes[f.nodes[1]], &c = brick.nodes[f.nodes[2]];
    const Vec3 area = 0.5 * (b - a).cross(c - a);
    flux += area.dot(a + b + c) / 3;
    sum += area;
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(f.nodes[i] == brick.tets[f.tet][tet_faces[f.face][i]]);
  }
  CHECK(flux == Approx(3 * 6.).epsilon(1e-12));
  CHECK(sum.norm() < 1e-12);
}

TEST_CASE("an inner face is seen from outside its first tet and lists the same nodes in both") {
  for (const InnerFace& f : inner_faces(brick)) {
    REQUIRE(f.tets[0] < f.tets[1]);
    for (std::size_t s = 0; s < 2; ++s)
      for (std::size_t i = 0; i < 3; ++i) {
        REQUIRE(brick.tets[f.tets[s]][f.corners[s][i]] == f.nodes[i]);
        REQUIRE(f.corners[s][i] != f.faces[s]); // the corner opposite to it
      }
    const Vec3& a = brick.nodes[f.nodes[0]];
    const Vec3 normal = (brick.nodes[f.nodes[1]] - a).cross(brick.nodes[f.nodes[2]] - a);
    REQUIRE(normal.dot(brick.nodes[brick.tets[f.tets[0]][f.faces[0]]] - a) < 0);
    REQUIRE(normal.dot(brick.nodes[brick.tets[f.tets[1]][f.faces[1]]] - a) > 0);
  }
}

TEST_CASE("lists of faces are in the order of tets and their faces") {
  const auto outer = outer_faces(brick);
  CHECK(std::is_sorted(outer.begin(), outer.end(), [](const OuterFace& a, const OuterFace& b) {
    return std::tie(a.tet, a.face) < std::tie(b.tet, b.face);
  }));
  const auto inner = inner_faces(brick);
  CHECK(std::is_sorted(inner.begin(), inner.end(), [](const InnerFace& a, const InnerFace& b) {
    return std::tie(a.tets[0], a.faces[0]) < std::tie(b.tets[0], b.faces[0]);
  }));
}

TEST_CASE("three tets on one face are refused with their numbers") {
  const std::vector<Tet> tets{{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 2, 1, 5}};
  CHECK_THROWS_WITH(face_neighbours(tets, 6), "tetrahedra 1, 2 and 3 share one face; at most two may");
}
