// Stiffness damping (Rayleigh's beta): vibrations die out at beta w^2 / 2, motion as a rigid body does not, and the
// stable step shrinks as beta w demands.
#include "libcdem/procedure/run.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

cdem::Elastic damped(double beta) {
  cdem::Elastic m = rock();
  m.poissons_ratio = 0;
  m.stiffness_damping = beta;
  return m;
}

System bar(double length, const cdem::Elastic& material) {
  return System(
      build({meshed("bar", geom::box_mesh({length, 0.2 * length, 0.2 * length}, {10, 2, 2}), {}, material)}));
}

} // namespace

TEST_CASE("stiffness damping: a bar's first mode dies out at beta w^2 / 2, and the ledger closes",
          "[damping][mesh]") {
  const double length = 1, w = 0.5 * pi * std::sqrt(rock().youngs_modulus / rock().density) / length;
  const double ratio = 0.03; // of critical damping
  System s = bar(length, damped(2 * ratio / w));
  s.hold(cdem::Selection::side("x-"), "xyz");
  for (std::size_t i = 0; i < s.model.node_position.size(); ++i)
    s.state.velocity[i].x = 1e-3 * std::sin(0.5 * pi * s.model.node_position[i].x() / length);
  const double before = cdem::energy(s.model, s.state).total();
  cdem::RunOptions options;
  const double periods = 5;
  options.duration = periods * 2 * pi / w;
  s.run(options);
  const cdem::EnergyLedger after = cdem::energy(s.model, s.state);
  const double stored = after.total() - after.damping;
  // The frequency of this coarse bar is within 0.5 % of the formula's.
  CHECK(std::log(before / stored) == Approx(2 * ratio * 2 * pi * periods).epsilon(0.01));
  CHECK(after.damping == Approx(before - stored).epsilon(1e-3));
}

TEST_CASE("stiffness damping: a body that flies and spins keeps its energy", "[damping][mesh]") {
  System s = bar(1, damped(1e-4));
  const Vec3 centre(0.5, 0.1, 0.1);
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
    s.state.velocity[i] = node(Vec3(3, -2, 1) + Vec3(0.2, 0.3, 0.5).cross(s.model.node_position[i] - centre));
  const double before = cdem::kinetic_energy(s.model, s.state);
  cdem::RunOptions options;
  options.steps = 20000;
  s.run(options);
  CHECK(cdem::kinetic_energy(s.model, s.state) == Approx(before).epsilon(1e-6));
}

TEST_CASE("stiffness damping: the stable step is 2 / w (sqrt(1 + z^2) - z), and holds", "[damping][mesh]") {
  const System without = bar(1, damped(0));
  const double w = 2 / cdem::stable_time_step(without.model), z = GENERATE(0.1, 1.0, 5.0);
  System s = bar(1, damped(2 * z / w));
  CHECK(cdem::stable_time_step(s.model) == Approx(2 / w * (std::sqrt(1 + z * z) - z)).epsilon(1e-9));
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
    s.state.velocity[i].x = i % 2 == 0 ? 1e-3 : -1e-3;
  const double before = cdem::energy(s.model, s.state).total();
  cdem::RunOptions options;
  options.steps = 2000;
  options.safety = 1;
  s.run(options);
  const cdem::EnergyLedger after = cdem::energy(s.model, s.state);
  CHECK(after.total() - after.damping < before);
  CHECK(after.damping > 0);
  CHECK(after.total() == Approx(before).epsilon(0.02));
}
