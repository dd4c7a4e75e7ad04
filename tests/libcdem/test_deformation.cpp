// How far a state is from small strain, and whether anything acts on a model.
#include "tests/libcdem/cohesive_concrete.hpp"

#include "libcdem/results/deformation.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

// Displacement u = H x of one block, the others at rest.
System with_gradient(const Mat3& gradient, int block) {
  System s(build({body("rock", geom::grid({0.3, 0.1, 0.1}, {3, 1, 1}))}));
  const cdem::Block& b = s.model.blocks[block];
  for (int n = b.node_begin; n < b.node_end; ++n)
    s.state.displacement[n] = node(gradient * s.model.node_position[n]);
  return s;
}

} // namespace

TEST_CASE("the largest principal strain is found, and in which block", "[deformation]") {
  const System s = with_gradient(symmetric(0.01, 0.005, -0.03, 0.002, 0, 0), 1);
  const cdem::Deformation d = cdem::largest_deformation(s.model, s.state);
  CHECK(d.strain == Approx(0.03).epsilon(1e-9));
  CHECK(d.strain_block == s.model.blocks[1].id);
  CHECK(d.turn < 1e-12);
}

TEST_CASE("a block's turn is found to second order, with the strain theta^2 / 2 that it feigns",
          "[deformation]") {
  const double theta = GENERATE(0.1, 1.0, 5.0) * degree;
  const System s = with_gradient(rotation({1, 2, -1}, theta) - Mat3::Identity(), 2);
  const cdem::Deformation d = cdem::largest_deformation(s.model, s.state);
  CHECK(d.turn == Approx(theta).epsilon(theta * theta));
  CHECK(d.turn_block == s.model.blocks[2].id);
  CHECK(d.strain == Approx(0.5 * theta * theta).epsilon(theta * theta));
}

TEST_CASE("loads, moved supports, tight bolts, initial stress and velocity act, what only holds does not",
          "[model]") {
  const auto fresh = [] { return simulation(geom::grid({0.2, 0.1, 0.1}, {2, 1, 1})); };
  cdem::Simulation s = fresh();
  CHECK_FALSE(s.anything_acts());
  s.fix(fixed(cdem::Selection::side("x-")));
  CHECK_FALSE(s.anything_acts());
  cdem::Fix pull = fixed(cdem::Selection::side("x-"));
  pull.displacement = Vec3(1e-5, 0, 0);
  s.fix(pull);
  CHECK(s.anything_acts());
  s = fresh();
  s.gravity({{0, 0, -9.81}, 0, {}});
  CHECK(s.anything_acts());
  s.clear_loads();
  CHECK_FALSE(s.anything_acts());
  s.initial_velocity(cdem::Selection::everything(), {1, 0, 0});
  CHECK(s.anything_acts());
  s = fresh();
  s.initial_stress(cdem::Selection::everything(), {1e6, 0, 0, 0, 0, 0});
  CHECK(s.anything_acts());
  s = fresh();
  s.traction(traction(cdem::Selection::side("x+"), {1e6, 0, 0}));
  CHECK(s.anything_acts());
  for (const double pretension : {0.0, 1e4}) {
    s = fresh();
    cdem::Bolt bolt;
    bolt.from = {0, 0.05, 0.05};
    bolt.to = {0.2, 0.05, 0.05};
    bolt.area = 1e-4;
    bolt.youngs_modulus = 200e9;
    bolt.grout_stiffness = 1e9;
    bolt.plate = true;
    bolt.free_length = 0.1;
    bolt.pretension = pretension;
    s.bolt(bolt);
    CHECK(s.anything_acts() == (pretension > 0));
  }
  cdem::ModelSpec spec;
  spec.bodies = {concrete_body(geom::box_mesh({0.2, 0.1, 0.1}, {2, 1, 1}, 0))};
  s = cdem::Simulation(spec, 1, nullptr);
  CHECK_FALSE(s.anything_acts());
  cdem::CrackPressure gas;
  gas.pressure = [](double) { return 1e6; };
  s.crack_pressure(gas);
  CHECK(s.anything_acts());
}
