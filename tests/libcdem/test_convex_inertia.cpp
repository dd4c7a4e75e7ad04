// Convex blocks that move far turn as the solid does: mass, centre of mass and moments of inertia of their nodes, and the
// period of a block that swings about one of its edges.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/polyhedron/polyhedron.hpp"
#include "tests/libcdem/boxes.hpp"

#include <algorithm>
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

TEST_CASE("wedges and pyramids that move far have the solid's mass, centre and moments of inertia",
          "[moving]") {
  struct Shape {
    std::vector<Vec3> points;
    Vec3 centroid;
    double volume;
    Mat3 moments; // integral r r^T dV about the centroid
  };
  // A triangle of legs a, b: a^2/18, b^2/18 and -ab/36 of its area; a pyramid on a^2 of height h: a^2/20 and 3 h^2/80 of
  // its volume.
  const double a = 2, b = 1, length = 0.7, h = 1.5;
  Mat3 wedge =
      (0.5 * a * b * length) * symmetric(a * a / 18, b * b / 18, length * length / 12, -a * b / 36, 0, 0);
  Mat3 pyramid = (a * a * h / 3) * symmetric(a * a / 20, a * a / 20, 3 * h * h / 80, 0, 0, 0);
  const Shape shapes[] = {{{{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, length}, {a, 0, length}, {0, b, length}},
                           {a / 3, b / 3, length / 2},
                           0.5 * a * b * length,
                           wedge},
                          {{{0, 0, 0}, {a, 0, 0}, {0, a, 0}, {a, a, 0}, {a / 2, a / 2, h}},
                           {a / 2, a / 2, h / 4},
                           a * a * h / 3,
                           pyramid}};
  const Mat3 turn = rotation({1, -2, 0.4}, 0.7);
  const Vec3 away(300, -70, 20);
  for (const Shape& shape : shapes) {
    geom::Assembly assembly;
    std::vector<Vec3> points;
    for (const Vec3& x : shape.points)
      points.push_back(turn * x + away);
    assembly.blocks.push_back(geom::convex_hull(points));
    const System s(build({moving(assembly)}));
    const Sums sums = of_nodes(s.model, s.model.blocks[0]);
    const double density = rock().density;
    CHECK(sums.mass == Approx(density * shape.volume).epsilon(1e-12));
    CHECK((sums.centroid - (turn * shape.centroid + away)).norm() < 1e-9);
    const Mat3 expected = density * turn * shape.moments * turn.transpose();
    CHECK((sums.moments - expected).norm() < 1e-8 * expected.norm());
    CHECK(*std::min_element(s.model.node_mass.begin(), s.model.node_mass.end()) > 0);
  }
}

namespace {

// integral r r^T dm of a block about its centroid, by a rule of four points in each tetrahedron that is exact for squares.
Mat3 of_solid(const cdem::Model& model, const cdem::Block& block) {
  Mat3 sum = Mat3::Zero();
  for (int tet = block.tet_begin; tet < block.tet_end; ++tet) {
    const auto corner = [&](int i) -> Vec3 {
      return model.node_position[model.tets[tet][i]] - block.mass.centroid;
    };
    const double volume =
        (corner(1) - corner(0)).dot((corner(2) - corner(0)).cross(corner(3) - corner(0))) / 6;
    const double b = (5 - std::sqrt(5.0)) / 20, a = 1 - 3 * b;
    for (int i = 0; i < 4; ++i) {
      Vec3 point = Vec3::Zero();
      for (int j = 0; j < 4; ++j)
        point += (i == j ? a : b) * corner(j);
      sum += rock().density * volume / 4 * point * point.transpose();
    }
  }
  return sum;
}

} // namespace

TEST_CASE("Voronoi cells and zoned blocks that move far have the solid's mass, centre and moments of inertia",
          "[moving]") {
  geom::VoronoiOptions cells;
  cells.count = 20;
  cells.origin = {40, -7, 3};
  std::vector<cdem::BodySpec> bodies{moving(geom::voronoi(cells)), moving(one_box({1, 1, 1}))};
  bodies[1].name = "zones";
  bodies[1].zone_size = 0.3;
  const System s(build(bodies));
  for (const cdem::Block& block : s.model.blocks) {
    const Sums sums = of_nodes(s.model, block);
    CHECK(sums.mass == Approx(rock().density * block.mass.volume).epsilon(1e-12));
    CHECK((sums.centroid - block.mass.centroid).norm() < 1e-9 * block.size);
    const Mat3 solid = of_solid(s.model, block);
    CHECK((sums.moments - solid).norm() < 1e-8 * solid.norm());
  }
  CHECK(*std::min_element(s.model.node_mass.begin(), s.model.node_mass.end()) > 0);
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
