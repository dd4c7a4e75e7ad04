// Patch tests across interfaces whose two sides do not match: uniform stress in every tet, traction stress .
// n and jump K^-1 traction in every spring.
#include "tests/libcdem/random_cuts.hpp"
#include "tests/libcdem/system.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/polyhedron/cut.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

const geom::Mat3 oblique_stress = 1e6 * symmetric(-3, 2, 1, 0.5, -0.7, 0.9);

// Largest difference between a spring's jump and t_n / kn n + t_s / ks, over the largest of these.
double jump_error(const System& s, const geom::Mat3& stress) {
  double error = 0, scale = 0;
  for (int i = 0; i < static_cast<int>(s.model.points.size()); ++i) {
    const cdem::BondPoint& p = s.model.points[i];
    const cdem::Interface& face = s.model.interfaces[p.interface];
    const Vec3 t = stress * p.normal;
    const double tn = t.dot(p.normal);
    const Vec3 expected = tn / face.kn * p.normal + (t - tn * p.normal) / face.ks;
    error = std::max(error, (cdem::jump(s.model, s.state.displacement, i) - expected).norm());
    scale = std::max(scale, expected.norm());
  }
  return error / scale;
}

// From above, free to widen.
void press(System& s, double pressure) {
  s.conditions.tractions = {traction(cdem::Selection::side("z+"), {0, 0, -pressure})};
  s.hold(cdem::Selection::side("z-"), "z");
  s.hold(at_place({0, 0, 0}), "xyz");
  s.hold(at_place({1, 0, 0}), "yz");
}

} // namespace

TEST_CASE("two blocks that overlap on part of an oblique face carry any stress uniformly", "[patch]") {
  const geom::Plane plane = geom::Plane::through({0.5, 0.5, 0.5}, {0.3, 0.2, 1});
  geom::Assembly below, above;
  below.blocks = {geom::cut(geom::make_box({0, 0, 0}, {1, 1, 1}), plane).below->shape};
  geom::Assembly upper;
  upper.blocks = {geom::make_box({0.1, -0.2, 0.1}, {1.2, 0.8, 1.3})};
  upper = geom::rotated(upper, {0, 0.1, 1}, 25 * degree, {0.5, 0.5, 0.5});
  above.blocks = {geom::cut(upper.blocks[0], plane).above->shape};

  System s(build({body("below", below), body("above", above)}, {{"below", "above", rock_joint()}}));
  REQUIRE(s.model.interfaces.size() == 1);
  s.load_all_faces(oblique_stress);
  REQUIRE(s.relax(1e-11).converged);
  CHECK(stress_error(s, oblique_stress) < 1e-6);
  CHECK(traction_error(s, oblique_stress) < 1e-5);
  CHECK(jump_error(s, oblique_stress) < 1e-6);
}

TEST_CASE(
    "columns of Voronoi cells stand on a grid under uniaxial stress: uniform stress and jump sigma over k",
    "[patch]") {
  geom::VoronoiOptions cells;
  cells.size = {1, 1, 0.4};
  cells.origin = {0, 0, 0.4};
  cells.count = 15;
  cells.extruded = true;
  // Blocks of different sizes: one thickness, so that the jump can be the same everywhere.
  cdem::Joint joint = rock_joint();
  joint.thickness = 0.005;
  System s(build({body("grid", geom::grid({1, 1, 0.4}, {3, 4, 1})), body("cells", geom::voronoi(cells))},
                 {{"grid", "cells", joint}}));
  const geom::Mat3 stress = symmetric(0, 0, -2e6, 0, 0, 0);
  press(s, 2e6);
  REQUIRE(s.relax(1e-11).converged);
  CHECK(stress_error(s, stress) < 1e-6);
  CHECK(traction_error(s, stress) < 1e-5);
  CHECK(jump_error(s, stress) < 1e-6);
}

TEST_CASE("one block under any stress and cut into 50 at random stays as it was", "[patch]") {
  geom::Assembly shape;
  shape.blocks = {geom::make_box({0, 0, 0}, {1, 0.8, 0.6})};
  System s(build({body("rock", shape)}));
  s.conditions.tractions = on_six_sides(oblique_stress);
  REQUIRE(s.relax(1e-12).converged);
  while (s.model.blocks.size() < 50)
    cut_at_random(s, {largest_block(s.model)}, 11);
  REQUIRE(s.model.blocks.size() == 50);

  CHECK(s.out_of_balance() < 1e-9); // before any relaxing
  CHECK(stress_error(s, oblique_stress) < 1e-6);
  CHECK(traction_error(s, oblique_stress) < 1e-5);
  s.relax(1e-11);
  CHECK(stress_error(s, oblique_stress) < 1e-6);
  CHECK(traction_error(s, oblique_stress) < 1e-5);
}

TEST_CASE("fifty blocks with loaded springs and each cut at random twice keep uniform stress", "[patch]") {
  System s(build({body("rock", geom::grid({1, 1, 0.4}, {5, 5, 2}))}));
  const geom::Mat3 stress = symmetric(0, 0, -4e6, 0, 0, 0);
  press(s, 4e6);
  REQUIRE(s.relax(1e-12).converged);
  REQUIRE(stress_error(s, stress) < 1e-8);

  for (const int level : {1, 2}) {
    cut_at_random(s, all_blocks(s.model), 100 + level);
    INFO("level " << level << ": " << s.model.blocks.size() << " blocks");
    CHECK(s.model.blocks.size() == (level == 1 ? 100 : 200));
    CHECK(s.out_of_balance() < 1e-9);
    CHECK(stress_error(s, stress) < 1e-6);
    CHECK(traction_error(s, stress) < 1e-5);
  }
  REQUIRE(s.relax(1e-11).converged);
  CHECK(stress_error(s, stress) < 1e-6);
  CHECK(traction_error(s, stress) < 1e-5);
}

// Unloaded springs: the jumps that the tractions need cannot close round an edge where faces of different
// directions meet, so blocks near it are bent. The bending is of the order of the jumps, sigma L / E, over
// the block size.
TEST_CASE("across unloaded springs and T-junctions the stress error falls as L over h to the power 0.9",
          "[patch]") {
  geom::VoronoiOptions cells;
  cells.count = 30;
  cells.relaxations = 1;
  cells.size = {1, 1, 0.5};
  geom::Assembly shape = geom::voronoi(cells);
  shape = geom::cut_by_plane(shape, geom::Plane::through({0.5, 0.5, 0.2}, {0.1, 0.3, 1}),
                             {geom::Box{{0.2, 0.2, 0}, {0.8, 0.8, 0.5}}, 0.01});
  const geom::Mat3 stress = symmetric(0, 0, -2e6, 0, 0, 0);
  const auto error = [&](double thickness_ratio) {
    cdem::Joint joint = rock_joint();
    joint.thickness_ratio = thickness_ratio;
    System s(build({body("rock", shape, rock(), joint)}));
    s.load_all_faces(stress);
    REQUIRE(s.relax(1e-9).converged);
    double sum = 0, volume = 0; // volume-weighted mean square over the blocks
    for (int b = 0; b < static_cast<int>(s.model.blocks.size()); ++b) {
      const double v = s.model.blocks[b].mass.volume;
      sum += v * (cdem::matrix(cdem::block_stress(s.model, s.state, b)) - stress).squaredNorm();
      volume += v;
    }
    return std::sqrt(sum / volume) / stress.norm();
  };
  const double at_4 = error(0.04), at_2 = error(0.02), at_1 = error(0.01), at_half = error(0.005);
  CAPTURE(at_4, at_2, at_1, at_half);
  // Measured 0.86, 0.88, 0.90: the order rises towards 1 as the layers become thin against the smallest
  // faces.
  const double first = std::log2(at_4 / at_2), second = std::log2(at_2 / at_1),
               third = std::log2(at_1 / at_half);
  CHECK(first > 0.8);
  CHECK(second > first);
  CHECK(third > second);
  CHECK(third < 1.1);
}
