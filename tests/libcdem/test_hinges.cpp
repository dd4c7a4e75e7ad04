// Two tetrahedra that swing about the last point that holds them: once they have turned from each other by more than 60 degrees that
// point tears, and no energy comes from where the mean of the two sides has no direction.
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double leg = 0.13; // m

cdem::Simulation swinging(const cdem::Bonding& bonding, unsigned seed, double spin) {
  const geom::TetMesh two{{{0, 0, 0}, {leg, 0, 0}, {0, leg, 0}, {0, 0, leg}, {leg, leg, leg}},
                          {{0, 1, 2, 3}, {1, 2, 3, 4}},
                          {0, 0}};
  cdem::Joint joint;
  joint.tensile_strength = 3e5;
  joint.cohesion = 9e5;
  joint.friction_angle = 30 * degree;
  if (bonding.is_cohesive()) {
    joint.softening = cdem::Softening::linear;
    joint.fracture_energy_1 = 30;
    joint.fracture_energy_2 = 300;
  }
  cdem::ModelSpec spec;
  spec.bodies = {meshed("two", two, bonding, {1e9, 0.2, 2500}, joint)};
  cdem::Joint rubbing;
  rubbing.bonded = false;
  rubbing.friction_angle = joint.friction_angle;
  spec.pairs = {{"two", "two", rubbing}};
  cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
  std::mt19937 random(seed);
  for (const Vec3& apex : {Vec3(0, 0, 0), Vec3(leg, leg, leg)}) {
    Vec3 velocity;
    for (int axis = 0; axis < 3; ++axis)
      velocity[axis] = spin * leg * (2.0 * static_cast<double>(random()) / 4294967295.0 - 1); // m/s
    const double e = 1e-4;
    s.initial_velocity(cdem::Selection::in_box({apex - Vec3(e, e, e), apex + Vec3(e, e, e)}), velocity);
  }
  return s;
}

} // namespace

TEST_CASE("hinges: tetrahedra that swing about their last point gain no energy", "[fracture][energy]") {
  // A brittle cohesive face has no last point: all three go together.
  const auto kind = GENERATE(cdem::BondKind::cohesive, cdem::BondKind::springs);
  cdem::Bonding bonding;
  bonding.kind = kind;
  bonding.everywhere = true;
  int parted = 0;
  for (unsigned seed = 1; seed <= 24; ++seed) {
    cdem::Simulation s = swinging(bonding, seed, 16 + 0.5 * seed);
    const double given = s.energy().kinetic; // J
    cdem::RunOptions options;
    options.duration = 0.6;
    INFO("seed " << seed);
    REQUIRE_NOTHROW(s.run(options));
    const cdem::EnergyLedger now = s.energy();
    CHECK(now.kinetic + now.elastic + now.springs < 1.1 * given);
    parted += s.counts().broken_tension + s.counts().broken_shear == 3;
  }
  CHECK(parted > 4);
}
