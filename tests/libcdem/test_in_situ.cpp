// Stress that grows with depth, how far from balance a model is, and displacement set to zero.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/random_cuts.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace testing;
using Catch::Matchers::Contains;
using cdem::Selection;
using geom::Vec3;

namespace {

double weight_per_volume() { // Pa/m
  return rock().density * 9.81;
}

// A column of 0.1 x 0.1 x 0.5 m in a smooth box, under its weight.
cdem::Simulation column(cdem::Element element, const cdem::Elastic& material = rock()) {
  cdem::BodySpec spec = body("rock", geom::grid({0.1, 0.1, 0.5}, {1, 1, 5}), material);
  spec.element = element;
  cdem::ModelSpec model;
  model.bodies = {spec};
  cdem::Simulation s(model, 1, nullptr);
  s.fix(fixed(Selection::side("z-"), "z"));
  for (const char* side : {"x-", "x+"})
    s.fix(fixed(Selection::side(side), "x"));
  for (const char* side : {"y-", "y+"})
    s.fix(fixed(Selection::side(side), "y"));
  s.gravity(gravity());
  return s;
}

cdem::InitialStress in_situ(double kx, double ky) {
  cdem::InitialStress field;
  field.on = Selection::everything();
  field.gradient = weight_per_volume();
  field.k0 = {kx, ky};
  return field;
}

} // namespace

TEST_CASE("stress with depth is in balance with gravity from the start", "[in_situ]") {
  cdem::Simulation s = column(GENERATE(cdem::Element::small_strain, cdem::Element::finite_volume));
  CHECK(s.unbalance().largest > 0.1); // without it
  s.initial_stress(in_situ(0.5, 1.5));
  CHECK(s.unbalance().largest < 1e-9);
  CHECK(s.unbalance().mean <= s.unbalance().largest);
  const double weight = weight_per_volume() * 0.1 * 0.1 * 0.5;
  CHECK(s.reaction(Selection::side("z-")).z() == Approx(weight).epsilon(1e-9));
  for (const double z : {0.05, 0.25, 0.45}) {
    const double vertical = -weight_per_volume() * (0.5 - z);
    CHECK(s.at("stress.zz", {0.05, 0.05, z}) == Approx(vertical).epsilon(1e-9));
    CHECK(s.at("stress.xx", {0.05, 0.05, z}) == Approx(0.5 * vertical).epsilon(1e-9));
    CHECK(s.at("stress.yy", {0.05, 0.05, z}) == Approx(1.5 * vertical).epsilon(1e-9));
  }
  REQUIRE(s.relax({}).converged);
  const double settlement =
      weight_per_volume() * 0.5 * 0.5 / rock().youngs_modulus; // m, order of what it spares
  CHECK(s.max("displacement.magnitude").value < 1e-6 * settlement);
}

TEST_CASE("depth counts from the surface, and there is no stress above it", "[in_situ]") {
  cdem::InitialStress field = in_situ(1, 2);
  field.stress = {-1, 0, 0, 0, 0, 5};
  field.surface = 3.0;
  const double g = weight_per_volume();
  CHECK(cdem::stress_at(field, 10, {0, 0, 1}) == cdem::Stress{-1 - 2 * g, -4 * g, -2 * g, 0, 0, 5});
  CHECK(cdem::stress_at(field, 10, {0, 0, 4}) == field.stress);
  field.surface.reset();
  CHECK(cdem::stress_at(field, 2, {0, 0, 1})[2] == -g);
}

// On a plane that dips by a: normal pressure p (cos2 a + k sin2 a), shear p (1 - k) sin a cos a.
TEST_CASE("a K0 that a joint cannot bear is told of with the use of its strength", "[in_situ]") {
  const double k0 = GENERATE(0.2, 0.5), a = 45 * degree, phi = 30 * degree;
  const bool bonded = GENERATE(true, false);
  cdem::Joint joint = rock_joint();
  joint.bonded = bonded;
  joint.cohesion = joint.tensile_strength = 0;
  joint.friction_angle = phi;
  cdem::Simulation s =
      simulation(geom::cut_by_plane(geom::grid({1, 1, 1}, {1, 1, 1}),
                                    geom::Plane::through({0.5, 0.5, 0.4}, {std::sin(a), 0, std::cos(a)})),
                 rock(), joint);
  const cdem::BeyondStrength beyond = s.initial_stress(in_situ(k0, k0));
  const double use = (1 - k0) * std::sin(a) * std::cos(a) /
                     ((std::cos(a) * std::cos(a) + k0 * std::sin(a) * std::sin(a)) * std::tan(phi));
  CHECK(beyond.largest_utilisation == Approx(use).epsilon(1e-9));
  CHECK(beyond.points == (use > 1 ? s.counts().bonds : 0));
}

TEST_CASE("cohesive meshes take a stress with depth, meshes with springs do not", "[in_situ]") {
  cdem::Bonding bonding;
  bonding.everywhere = true;
  const bool cohesive = GENERATE(true, false);
  if (cohesive) {
    bonding.kind = cdem::BondKind::cohesive;
    bonding.stiffness_ratio = 1;
  }
  cdem::ModelSpec model;
  model.bodies = {meshed("rock", geom::box_mesh({1, 1, 1}, {2, 2, 2}), bonding)};
  cdem::Simulation s(model, 1, nullptr);
  if (!cohesive) {
    CHECK_THROWS_WITH(s.initial_stress(in_situ(1, 1)), Contains("cohesive meshes"));
    return;
  }
  s.fix(fixed(Selection::side("z-"), "z"));
  for (const char* side : {"x-", "x+"})
    s.fix(fixed(Selection::side(side), "x"));
  for (const char* side : {"y-", "y+"})
    s.fix(fixed(Selection::side(side), "y"));
  s.gravity(gravity());
  s.initial_stress(in_situ(0.5, 0.5));
  CHECK(s.unbalance().largest < 1e-9);
}

TEST_CASE("unbalance needs a reference where no gravity acts", "[in_situ]") {
  cdem::Simulation s = simulation(geom::grid({1, 1, 1}, {1, 1, 1}));
  CHECK_THROWS_WITH(s.unbalance(), Contains("reference = missing"));
  s.traction(traction(Selection::side("x+"), {1e6, 0, 0}));
  // Five nodes of the face: its four corners carry A / 6 each and its centre A / 3.
  CHECK(s.unbalance(1e6).largest == Approx(1.0 / 3).epsilon(1e-9));
  CHECK(s.unbalance(1e6).force == Approx(1e6 / 3).epsilon(1e-9));
}

// A column of n = 5 blocks of size h whose two upper ones are taken away springs back by w (3 h / E + 2 / kn), w their
// weight per area, kn = E / (0.02 h).
TEST_CASE("after a reset an excavation shows its own convergence alone", "[in_situ]") {
  cdem::Elastic material = rock();
  material.poissons_ratio = 0;
  cdem::Simulation s = column(cdem::Element::small_strain, material);
  REQUIRE(s.relax({}).converged);
  CHECK(s.min("displacement.z").value < 0);
  const std::uint64_t mechanics = s.state_hash();
  s.reset_displacement();
  CHECK(s.state_hash() == mechanics);
  CHECK(s.max("displacement.magnitude").value == 0);
  CHECK(s.blocks()[4].displacement.norm() == 0);
  CHECK(s.remove(Selection::in_box({{-1, -1, 0.3}, {1, 1, 1}})) == 2);
  CHECK(s.max("displacement.magnitude").value == 0);
  REQUIRE(s.relax({}).converged);
  const double h = 0.1, unloaded = weight_per_volume() * 2 * h;
  CHECK(s.max("displacement.z").value ==
        Approx(unloaded / material.youngs_modulus * (3 * h + 2 * 0.02 * h)).epsilon(1e-4));
  const cdem::Snapshot shown = s.snapshot("after");
  CHECK(shown.point_fields[0].name == "displacement");
}

TEST_CASE("the reset changes no bit of what follows, and is saved with the model", "[in_situ]") {
  const auto built = [] { return column(cdem::Element::finite_volume); };
  cdem::Simulation plain = built(), reset = built(), resumed = built();
  for (cdem::Simulation* s : {&plain, &reset})
    s->relax({});
  reset.reset_displacement();
  resumed.restore(reset.save());
  for (cdem::Simulation* s : {&plain, &reset, &resumed}) {
    s->gravity(gravity({0, 0, -20}));
    s->relax({});
  }
  CHECK(plain.state_hash() == reset.state_hash());
  CHECK(resumed.state_hash() == reset.state_hash());
  CHECK(resumed.min("displacement.z").value == reset.min("displacement.z").value);
  CHECK(plain.min("displacement.z").value < 1.5 * reset.min("displacement.z").value);
}

TEST_CASE("blocks that are cut keep their zero of displacement", "[in_situ]") {
  System s(build({body("rock", geom::grid({1, 1, 1}, {2, 1, 1}))}));
  s.hold(Selection::side("z-"), "xyz");
  s.conditions.tractions = {traction(Selection::side("z+"), {1e6, 0, -2e6})};
  s.relax(1e-6);
  s.state.displacement_zero = s.state.displacement;
  cut_at_random(s, {0, 1}, 3);
  REQUIRE(s.model.blocks.size() == 4);
  REQUIRE(s.state.displacement_zero.size() == s.model.node_position.size());
  for (int node = 0; node < static_cast<int>(s.state.displacement.size()); ++node)
    CHECK(cdem::vec(cdem::shown_displacement(s.state, node)).norm() == 0);
}
