// One block: areas, mass properties against formulas, and what validate() refuses.
#include "libgeom/core/error.hpp"
#include "libgeom/polyhedron/polyhedron.hpp"
#include "tests/libgeom/random_shapes.hpp"

#include <catch2/catch.hpp>

using namespace geom;
using Catch::Matchers::Contains;
using testing::Draws;

namespace {

const Polyhedron corner_tet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                            {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}}};

Polyhedron moved(Polyhedron p, const Mat3& rotation, const Vec3& shift) {
  for (Vec3& x : p.vertices)
    x = rotation * x + shift;
  return p;
}

} // namespace

TEST_CASE("a box has 12 edges, 6 outward faces and the formula's volume, centroid and inertia") {
  const Vec3 size(2, 3, 5), corner(-1, 4, 2);
  const Polyhedron box = make_box(corner, corner + size);
  CHECK(edges(box).size() == 12);
  CHECK_NOTHROW(validate(box));
  for (int f = 0; f < 6; ++f)
    CHECK(face_normal(box, f).dot(face_centroid(box, f) - (corner + size / 2)) > 0);
  const MassProperties m = mass_properties(box);
  CHECK(m.volume == Approx(30).epsilon(1e-15));
  CHECK((m.centroid - (corner + size / 2)).norm() < 1e-14);
  const Vec3 expected(30.0 / 12 * (9 + 25), 30.0 / 12 * (4 + 25), 30.0 / 12 * (4 + 9));
  CHECK((m.inertia - Mat3(expected.asDiagonal())).norm() < 1e-12);
}

TEST_CASE("a corner tetrahedron has the formula's volume, centroid and inertia") {
  const MassProperties m = mass_properties(corner_tet);
  CHECK(m.volume == Approx(1.0 / 6).epsilon(1e-15));
  CHECK((m.centroid - Vec3::Constant(0.25)).norm() < 1e-15);
  // int x2 = 1/60, int x y = 1/120 about the corner; less V/16 for the centroid.
  const double square = 1.0 / 60 - 1.0 / 96, product = 1.0 / 120 - 1.0 / 96;
  Mat3 expected = Mat3::Constant(-product);
  expected.diagonal().setConstant(2 * square);
  CHECK((m.inertia - expected).norm() < 1e-16);
}

TEST_CASE("mass properties turn and move with the block, also a million sizes away") {
  Draws draws{1, 1};
  for (int i = 0; i < 50; ++i) {
    const Polyhedron p = testing::random_block(draws);
    const Mat3 q = Eigen::AngleAxisd(draws.uniform(0, 3), draws.direction()).toRotationMatrix();
    const MassProperties here = mass_properties(p);
    for (const auto& [distance, tolerance] : {std::pair{1.0, 1e-14}, std::pair{1e6, 1e-8}}) {
      const Vec3 shift = distance * draws.direction();
      const MassProperties there = mass_properties(moved(p, q, shift));
      CHECK(there.volume == Approx(here.volume).epsilon(tolerance));
      CHECK((there.centroid - (q * here.centroid + shift)).norm() < tolerance);
      CHECK((there.inertia - q * here.inertia * q.transpose()).norm() < tolerance);
    }
  }
}

TEST_CASE("a face's centroid is its area centroid, wherever its loop starts") {
  // Trapezium with parallel sides 2 and 1 at height 0 and 1: centroid at height (2 + 2 * 1) / (3 (2 + 1)) =
  // 4/9.
  Polyhedron p{{{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}},
               {{{0, 3, 2, 1}}, {{0, 1, 4}}, {{1, 2, 4}}, {{2, 3, 4}}, {{3, 0, 4}}}};
  for (int turn = 0; turn < 4; ++turn) {
    std::rotate(p.faces[0].loop.begin(), p.faces[0].loop.begin() + 1, p.faces[0].loop.end());
    CHECK(face_centroid(p, 0).y() == Approx(4.0 / 9).epsilon(1e-15));
    CHECK(face_area(p, 0) == Approx(1.5).epsilon(1e-15));
    CHECK((face_normal(p, 0) + Vec3::UnitZ()).norm() < 1e-15);
  }
}

TEST_CASE("the divergence theorem holds: 3 V = sum of A n . x over the faces") {
  Draws draws{2, 1};
  for (int i = 0; i < 200; ++i) {
    const Polyhedron p = testing::random_block(draws);
    double sum = 0;
    for (int f = 0; f < static_cast<int>(p.faces.size()); ++f)
      sum += face_area(p, f) * face_normal(p, f).dot(face_centroid(p, f));
    CHECK(sum / 3 == Approx(mass_properties(p).volume).epsilon(1e-13));
  }
}

TEST_CASE("validate names what is wrong with a block") {
  CHECK_NOTHROW(validate(corner_tet));
  Polyhedron p = corner_tet;
  SECTION("too few faces") {
    p.faces.pop_back();
    CHECK_THROWS_WITH(validate(p), Contains("4 vertices and 3 faces"));
  }
  SECTION("an open surface") {
    p = make_box({0, 0, 0}, {1, 1, 1});
    p.faces.pop_back();
    CHECK_THROWS_WITH(validate(p), Contains("must be closed"));
  }
  SECTION("a face the wrong way round") {
    std::reverse(p.faces[2].loop.begin(), p.faces[2].loop.end());
    CHECK_THROWS_WITH(validate(p), Contains("walked twice"));
  }
  SECTION("all faces inward") {
    for (PolyhedronFace& face : p.faces)
      std::reverse(face.loop.begin(), face.loop.end());
    CHECK_THROWS_WITH(validate(p), Contains("looks inward"));
  }
  SECTION("a vertex that no face uses") {
    p.vertices.push_back({0.1, 0.1, 0.1});
    CHECK_THROWS_WITH(validate(p), Contains("must be 2"));
  }
  SECTION("an index out of range") {
    p.faces[0].loop[0] = 9;
    CHECK_THROWS_WITH(validate(p), Contains("vertex 9"));
  }
  SECTION("a loop of two") {
    p.faces[0].loop.pop_back();
    CHECK_THROWS_WITH(validate(p), Contains("face 0 has 2 vertices"));
  }
  SECTION("a loop that passes a vertex twice") {
    p.faces[0].loop.push_back(p.faces[0].loop[0]);
    CHECK_THROWS_WITH(validate(p), Contains("twice"));
  }
  SECTION("NaN") {
    p.vertices[2].y() = std::nan("");
    CHECK_THROWS_WITH(validate(p), Contains("vertex 2 = {0, nan, 0}"));
  }
  SECTION("a warped face") {
    p = make_box({0, 0, 0}, {1, 1, 1});
    p.vertices[6].z() += 1e-6;
    CHECK_THROWS_WITH(validate(p), Contains("is warped"));
  }
  SECTION("a dented block") {
    p = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.1, 0.1}},
         {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 4}}, {{2, 3, 4}}, {{3, 1, 4}}}};
    CHECK_THROWS_WITH(validate(p), Contains("not convex"));
  }
  SECTION("no volume") {
    p.vertices[3] = {0.3, 0.3, 0};
    CHECK_THROWS_AS(validate(p), InputError);
  }
}
