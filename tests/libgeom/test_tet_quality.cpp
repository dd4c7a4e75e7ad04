// Shape measures against the regular and the right-angled tetrahedron; what makes a mesh invalid; size
// fields.
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/boundary.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/mesh/mesh_size.hpp"
#include "libgeom/mesh/tet_quality.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace geom;
using Catch::Matchers::Contains;

namespace {

const double edge = std::sqrt(8.); // of the regular tet below
const Vec3 a(1, 1, 1), b(1, -1, -1), c(-1, 1, -1), d(-1, -1, 1);

TetMesh right_angled() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, {0}};
}

} // namespace

TEST_CASE("a regular tet has radius ratio 1 and dihedral angles of arccos(1/3)") {
  const TetShape s = tet_shape(a, b, c, d);
  CHECK(std::abs(s.volume) == Approx(edge * edge * edge / (6 * std::sqrt(2.))));
  CHECK(s.radius_ratio == Approx(1));
  CHECK(s.min_dihedral == Approx(std::acos(1. / 3)));
  CHECK(s.max_dihedral == Approx(std::acos(1. / 3)));
  CHECK(s.min_height == Approx(edge * std::sqrt(2. / 3)));
}

TEST_CASE("a right-angled tet has r = 1/(3 + sqrt 3) and R = sqrt(3)/2") {
  const TetShape s = tet_shape({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  CHECK(s.radius_ratio == Approx(3 / (3 + std::sqrt(3.)) / (std::sqrt(3.) / 2)));
  CHECK(s.max_dihedral == Approx(M_PI / 2));
  CHECK(s.min_dihedral == Approx(std::acos(1 / std::sqrt(3.))));
  CHECK(s.min_height == Approx(1 / std::sqrt(3.)));
}

TEST_CASE("measures do not depend on the order of corners, place or size") {
  const Vec3 p[4] = {{0.1, 0.2, 0}, {1.3, 0, 0.1}, {0.2, 0.9, -0.1}, {0.4, 0.3, 1.2}};
  const TetShape first = tet_shape(p[0], p[1], p[2], p[3]);
  const TetShape turned = tet_shape(p[1], p[2], p[0], p[3]);
  const Vec3 shift(100, 200, 300);
  const TetShape moved = tet_shape(7 * p[0] + shift, 7 * p[1] + shift, 7 * p[2] + shift, 7 * p[3] + shift);
  for (const TetShape& s : {turned, moved}) {
    CHECK(s.radius_ratio == Approx(first.radius_ratio).epsilon(1e-9));
    CHECK(s.min_dihedral == Approx(first.min_dihedral).epsilon(1e-9));
    CHECK(s.max_dihedral == Approx(first.max_dihedral).epsilon(1e-9));
  }
  CHECK(moved.min_height == Approx(7 * first.min_height).epsilon(1e-9));
}

TEST_CASE("the quality of a mesh sums volumes and counts outer faces") {
  TetMesh mesh = right_angled();
  mesh.nodes.push_back({1, 1, 1});
  mesh.tets.push_back({1, 2, 3, 4}); // on the slanted face
  mesh.region.push_back(0);
  validate(mesh, "mesh");
  const MeshQuality q = quality(mesh);
  CHECK(q.tets == 2);
  CHECK(q.outer_faces == 6);
  CHECK(q.volume == Approx(1. / 6 + 1. / 3));
  CHECK(q.min_volume == Approx(1. / 6));
  CHECK(q.max_volume == Approx(1. / 3));
  CHECK(q.min_edge == Approx(1));
  CHECK(q.max_edge == Approx(std::sqrt(2.)));
}

TEST_CASE("outer faces close: area vectors sum to zero, and faces are found by side, plane and direction") {
  const TetMesh mesh = right_angled();
  const auto faces = outer_faces(mesh);
  std::vector<int> all(faces.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = static_cast<int>(i);
  CHECK(measure(mesh, faces, all).area_vector.norm() < 1e-15);
  CHECK(measure(mesh, faces, all).area == Approx(1.5 + std::sqrt(3.) / 2));
  const FaceGroup lower = measure(mesh, faces, faces_on_side(mesh, faces, "z-"));
  CHECK(lower.area == Approx(0.5));
  CHECK((lower.area_vector - Vec3(0, 0, -0.5)).norm() < 1e-15);
  CHECK((lower.centroid - Vec3(1. / 3, 1. / 3, 0)).norm() < 1e-15);
  CHECK(faces_on_side(mesh, faces, "z+").empty());
  CHECK(faces_on_plane(mesh, faces, Plane::through({1, 0, 0}, {1, 1, 1}), 1e-12).size() == 1);
  CHECK(faces_towards(mesh, faces, {1, 1, 1}, 0.01).size() == 1);
  CHECK(faces_towards(mesh, faces, {1, 1, 1}, M_PI).size() == 4);
  CHECK_THROWS_WITH(faces_on_side(mesh, faces, "up"), "side = \"up\": must be one of x-, x+, y-, y+, z-, z+");
}

TEST_CASE("what no element can work on is named") {
  const auto message = [](const TetMesh& mesh) {
    return testing::refusal([&] { validate(mesh, "part.msh"); });
  };
  CHECK(message(right_angled()).empty());
  CHECK_THAT(message({}), Contains("part.msh: no tetrahedra"));
  TetMesh nan = right_angled();
  nan.nodes[2].y() = std::nan("");
  CHECK_THAT(message(nan), Contains("node 3 is at {0, nan, 0}"));
  TetMesh inverted = right_angled();
  std::swap(inverted.tets[0][0], inverted.tets[0][1]);
  CHECK_THAT(message(inverted), Contains("tetrahedron 1 near {0.25, 0.25, 0.25} is inverted"));
  TetMesh flat = right_angled();
  flat.nodes[3] = {0.5, 0.5, 0};
  CHECK_THAT(message(flat), Contains("is flat"));
  TetMesh missing = right_angled();
  missing.tets[0][3] = 9;
  CHECK_THAT(message(missing), Contains("names a node that is not there"));
  TetMesh thrice = right_angled();
  thrice.nodes.insert(thrice.nodes.end(), {{0, 0, -1}, {0, 0, -2}});
  thrice.tets.insert(thrice.tets.end(), {{0, 2, 1, 4}, {0, 2, 1, 5}});
  thrice.region = {0, 0, 0};
  CHECK_THAT(message(thrice), Contains("share one face"));
}

TEST_CASE("a size field is the smallest of what is asked for, growing with the distance") {
  MeshSize sizes{1.0, 0.5};
  sizes.refinements.push_back({{Vec3(0, 0, 0), Vec3(2, 0, 0)}, {}, 0.1, 0.2});
  Refinement box;
  box.box.extend({5, 0, 0});
  box.box.extend({6, 1, 1});
  box.size = 0.3;
  sizes.refinements.push_back(box);
  validate(sizes);
  CHECK(size_at(sizes, {1, 0.2, 0}) == Approx(0.1));       // within the radius of the line
  CHECK(size_at(sizes, {1, 1.2, 0}) == Approx(0.1 + 0.5)); // 1 m beyond it
  CHECK(size_at(sizes, {-100, 0, 0}) == Approx(1));
  CHECK(size_at(sizes, {5.5, 0.5, 0.5}) == Approx(0.3));
  CHECK(size_at(sizes, {5.5, 0.5, 2}) == Approx(0.3 + 0.5));
  CHECK(distance_to(sizes.refinements[0], {3, 0, 0}) == Approx(1));
  sizes.refinements[0].size = 0;
  CHECK_THROWS_WITH(validate(sizes), "refine.size = 0: must be finite and > 0 m");
}

TEST_CASE("a mesh has the volume, centroid and inertia of the box it fills, wherever it is") {
  TetMesh mesh = box_mesh({1, 2, 3}, {2, 2, 3}, 0.1);
  for (Vec3& x : mesh.nodes)
    x += Vec3(1e4, 2e4, -3e4);
  const MassProperties m = mass_properties(mesh);
  CHECK(m.volume == Approx(6).epsilon(1e-10));
  CHECK((m.centroid - Vec3(1e4 + 0.5, 2e4 + 1, -3e4 + 1.5)).norm() < 1e-9);
  const Mat3 exact = 0.5 * Vec3(4 + 9, 1 + 9, 1 + 4).asDiagonal().toDenseMatrix(); // V (b^2 + c^2) / 12
  CHECK((m.inertia - exact).norm() < 1e-9);
  CHECK(principal_inertia_ratio(m) == Approx(13. / 5).epsilon(1e-9));
}

TEST_CASE("the ratio of principal inertias does not depend on the axes") {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Mat3 diagonal = Vec3(2, 3, 4).asDiagonal();
  CHECK(principal_inertia_ratio({1, {0, 0, 0}, turn * diagonal * turn.transpose()}) == Approx(2));
}
