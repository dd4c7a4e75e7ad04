// Star blocks that move far turn as the solid does: mass, centre of mass and moments of inertia of their nodes, and the
// period of a block that swings about one of its edges.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/polyhedron/polyhedron.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

struct Sums {
  double mass = 0;
  Vec3 centroid = Vec3::Zero();
  Mat3 moments = Mat3::Zero(); // sum m r r^T about the centroid
};

Sums of_nodes(const cdem::Model& model, const cdem::Block& block) {
  Sums sums;
  for (int node = block.node_begin; node < block.node_end; ++node) {
    sums.mass += model.node_mass[node];
    sums.centroid += model.node_mass[node] * model.node_position[node];
  }
  sums.centroid /= sums.mass;
  for (int node = block.node_begin; node < block.node_end; ++node) {
    const Vec3 r = model.node_position[node] - sums.centroid;
    sums.moments += model.node_mass[node] * r * r.transpose();
  }
  return sums;
}

cdem::BodySpec moving(geom::Assembly shape) {
  cdem::BodySpec spec = body("block", std::move(shape));
  spec.element = cdem::Element::finite_volume;
  return spec;
}

geom::Assembly one_box(const Vec3& size) {
  return geom::grid(size, {1, 1, 1});
}

} // namespace

TEST_CASE("the nodes of a box that moves far have its mass and its moments of inertia", "[moving]") {
  const Vec3 size(2, 0.5, 1);
  const System s(build({moving(one_box(size))}));
  const Sums sums = of_nodes(s.model, s.model.blocks[0]);
  const double mass = rock().density * size.prod();
  CHECK(sums.mass == Approx(mass).epsilon(1e-12));
  CHECK((sums.centroid - 0.5 * size).norm() < 1e-12);
  const Mat3 expected = (mass / 12 * size.cwiseProduct(size)).asDiagonal();
  CHECK((sums.moments - expected).norm() < 1e-12 * expected.norm());
}

TEST_CASE("Voronoi blocks that move far have the mass, centre and trace of inertia of the solid",
          "[moving]") {
  geom::VoronoiOptions cells;
  cells.count = 20;
  cells.origin = {40, -7, 3};
  const System s(build({moving(geom::voronoi(cells))}));
  for (const cdem::Block& block : s.model.blocks) {
    const Sums sums = of_nodes(s.model, block);
    const double density = rock().density;
    CHECK(sums.mass == Approx(density * block.mass.volume).epsilon(1e-12));
    CHECK((sums.centroid - block.mass.centroid).norm() < 1e-10 * block.size);
    // The same from a mesh of the block's faces: rigid_shape integrates over the tetrahedra.
    double solid = 0;
    for (int tet = block.tet_begin; tet < block.tet_end; ++tet) {
      const auto corner = [&](int i) -> Vec3 {
        return s.model.node_position[s.model.tets[tet][i]] - block.mass.centroid;
      };
      const double volume =
          (corner(1) - corner(0)).dot((corner(2) - corner(0)).cross(corner(3) - corner(0))) / 6;
      // Points of a rule exact for squares: a = 0.5854..., b = 0.1382... of the corners.
      const double b = (5 - std::sqrt(5.0)) / 20, a = 1 - 3 * b;
      for (int i = 0; i < 4; ++i) {
        Vec3 point = Vec3::Zero();
        for (int j = 0; j < 4; ++j)
          point += (i == j ? a : b) * corner(j);
        solid += density * volume / 4 * point.squaredNorm();
      }
    }
    CHECK(sums.moments.trace() == Approx(solid).epsilon(1e-10));
  }
}

TEST_CASE("a deformable cube that hangs from one of its edges swings with the solid's period", "[moving]") {
  const double side = 1, g = 9.81, tilt = 0.05; // m, m/s2, rad
  System s(build({moving(one_box({side, side, side}))}));
  s.hold(
      cdem::Selection::where([&](const Vec3& x) { return x.x() < 1e-9 && x.z() > side - 1e-9; }, "its edge"),
      "xyz");
  // Its diagonal points along (1, 0, -1); gravity is turned from it by the tilt.
  const double angle = -45 * degree - tilt;
  s.conditions.gravity = gravity(g * Vec3(std::cos(angle), 0, std::sin(angle)));
  const double arm = side / std::sqrt(2.0),
               period = 2 * pi * std::sqrt(2.0 / 3 * side * side / (g * arm)) * (1 + tilt * tilt / 16);
  // After a whole period it is back, after half of one it is furthest away.
  cdem::RunOptions options;
  options.duration = period / 2;
  s.run(options);
  const Vec3 half = centroid(s, 0);
  s.run(options);
  const Vec3 back = centroid(s, 0) - Vec3(0.5, 0.5, 0.5) * side;
  const double swing = 2 * arm * std::sin(tilt);
  CHECK((half - Vec3(0.5, 0.5, 0.5) * side).norm() == Approx(swing).epsilon(0.01));
  CHECK(back.norm() < 0.01 * swing);
}
