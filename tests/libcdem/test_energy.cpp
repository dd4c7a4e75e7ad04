// The energy ledger: stored and spent terms against external work.
#include "tests/libcdem/columns.hpp"

#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

// A slab of Voronoi columns on a fixed floor, pressed by a moving head.
System pressed_slab(const cdem::Joint& joint) {
  geom::VoronoiOptions cells;
  cells.size = {0.2, 0.2, 0.04};
  cells.count = 25;
  cells.extruded = true;
  System s(build({body("rock", geom::voronoi(cells), rock(), joint)}));
  s.hold(cdem::Selection::side("y-"), "xyz");
  return s;
}

// Of the present ledger, J.
double imbalance(const System& s) {
  const cdem::EnergyLedger e = cdem::energy(s.model, s.state);
  return std::abs(e.total() - e.external);
}

cdem::Fix head() {
  cdem::Fix fix;
  fix.on = cdem::Selection::side("y+");
  return fix;
}

} // namespace

TEST_CASE("the ledger of an elastic bar under a sudden load balances to 1e-3 at half the stable step",
          "[energy]") {
  Bar bar;
  System s = bar.system();
  s.hold(cdem::Selection::side("x-"), "xyz");
  s.conditions.tractions = {traction(cdem::Selection::side("x+"), {1e6, 0, 0})};
  double worst = 0; // J
  cdem::RunOptions options;
  options.breaking = false;
  options.safety = 0.5;
  options.duration = 3 * 4 * bar.length / std::sqrt(bar.material().youngs_modulus / bar.material().density);
  options.callback_every = 7;
  options.callback = [&] { worst = std::max(worst, imbalance(s)); };
  s.run(options);
  CHECK(worst < 1e-3 * cdem::energy(s.model, s.state).external_peak);
  // Energies are not trivially zero: static stretch energy is sigma^2 V / 2 E, the sudden load swings to 4
  // times it.
  CHECK(cdem::energy(s.model, s.state).external_peak >
        3 * 0.5 * 1e12 / bar.material().youngs_modulus * bar.area());
}

TEST_CASE("a mesh had the elastic energy of the strain that its velocity has taken back since", "[energy]") {
  System s(build({meshed("box", geom::box_mesh({1, 0.8, 0.6}, {3, 2, 2}, 0.15))}));
  geom::Mat3 gradient; // 1/s, of the velocity
  gradient << 1e-3, 2e-3, -3e-3, 5e-4, -2e-3, 1e-3, 4e-3, -1e-3, 1.5e-3;
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
    s.state.velocity[i] = cdem::node(gradient * s.model.node_position[i]);
  const double lag = 0.5; // s
  const geom::Mat3 strain = 0.5 * lag * (gradient + gradient.transpose());
  const cdem::Elastic material = rock();
  const double density = 0.5 * material.lame_lambda() * strain.trace() * strain.trace() +
                         material.shear_modulus() * strain.squaredNorm(); // J/m3
  const double volume = 1 * 0.8 * 0.6 * (geom::Mat3::Identity() - lag * gradient).determinant();
  CHECK(cdem::mesh_elastic_energy(s.model, s.state, lag) == Approx(density * volume).epsilon(1e-10));
  CHECK(cdem::mesh_elastic_energy(s.model, s.state) == 0);
}

TEST_CASE("the ledger balances to 1 % while bonds break and faces slide", "[energy]") {
  System s = pressed_slab(rock_joint());
  s.conditions.fixes.push_back(head());
  s.conditions.fixes.back().velocity = Vec3(0, -0.1, 0);
  cdem::RunOptions options;
  options.duration = 3e-3;
  double worst = 0;
  options.callback_every = 50;
  options.callback = [&] { worst = std::max(worst, imbalance(s)); };
  const cdem::RunResult run = s.run(options);
  const cdem::EnergyLedger e = cdem::energy(s.model, s.state);
  CAPTURE(run.steps, run.broken_tension, run.broken_shear, e.elastic, e.springs, e.kinetic, e.friction,
          e.breaking, e.external);
  CHECK(run.broken_tension + run.broken_shear > 50);
  CHECK(e.friction > 0.05 * e.external);
  CHECK(e.breaking > 0);
  CHECK(e.balance_error() < 0.01);
  CHECK(worst < 0.01 * e.external_peak);
}

TEST_CASE("a relaxation's ledger balances, its fictitious kinetic energy counted", "[energy]") {
  const bool breaking = GENERATE(false, true);
  System s = pressed_slab(rock_joint());
  s.conditions.fixes.push_back(head());
  s.conditions.fixes.back().displacement = Vec3(0, -2e-4, 0);
  const cdem::RelaxResult relaxed = s.relax(1e-6, breaking);
  const cdem::EnergyLedger e = cdem::energy(s.model, s.state);
  CAPTURE(relaxed.steps, relaxed.broken_tension, relaxed.broken_shear, e.elastic, e.springs, e.kinetic,
          e.damping, e.friction, e.breaking, e.fictitious, e.external);
  CHECK(relaxed.converged);
  CHECK(e.kinetic == 0);
  CHECK((relaxed.broken_tension + relaxed.broken_shear > 50) == breaking);
  CHECK(e.balance_error() < (breaking ? 0.01 : 1e-3));
}

TEST_CASE("a relaxation that follows a run counts the velocities it takes away", "[energy]") {
  cdem::Simulation s = simulation(geom::grid({0.2, 0.1, 0.1}, {2, 1, 1}));
  s.fix(fixed(cdem::Selection::side("x-")));
  s.initial_velocity(cdem::Selection::side("x+"), {1, 0, 0});
  cdem::RunOptions options;
  options.breaking = false;
  options.steps = 200;
  options.safety = 0.1;
  s.run(options);
  const cdem::EnergyLedger moving = s.energy();
  REQUIRE(moving.kinetic > 0.2 * moving.external_peak);
  cdem::RelaxOptions relax;
  relax.breaking = false;
  s.relax(relax);
  CHECK(s.energy().balance_error() < 1e-3);
}

TEST_CASE("loaded statically a bar stores sigma^2 / 2 E in its blocks and sigma^2 / 2 kn in its joints",
          "[energy]") {
  Bar bar;
  bar.blocks = 6;
  System s = bar.system();
  s.hold(cdem::Selection::side("x-"), "xyz");
  s.conditions.tractions = {traction(cdem::Selection::side("x+"), {1e6, 0, 0})};
  REQUIRE(s.relax(1e-9).converged);
  const cdem::EnergyLedger e = cdem::energy(s.model, s.state);
  const double density = 0.5 * 1e12 / bar.material().youngs_modulus; // J/m3
  CHECK(e.elastic == Approx(density * bar.length * bar.area()).epsilon(1e-6));
  CHECK(e.springs == Approx(density * 5 * bar.thickness_ratio * bar.h() * bar.area()).epsilon(1e-6));
  // The constant load has given twice what is stored; the rest went into damping.
  CHECK(e.external == Approx(2 * (e.elastic + e.springs)).epsilon(1e-6));
}

TEST_CASE("an initial velocity counts as kinetic energy given from outside", "[energy]") {
  cdem::Simulation s = simulation(geom::grid({0.2, 0.1, 0.1}, {2, 1, 1}));
  s.initial_velocity(cdem::Selection::everything(), {3, 0, 4});
  const double expected = 0.5 * rock().density * 2e-3 * 25;
  CHECK(s.energy().kinetic == Approx(expected).epsilon(1e-12));
  CHECK(s.energy().external == Approx(expected).epsilon(1e-12));
  s.initial_velocity(cdem::Selection::everything(), {0, 0, 0});
  CHECK(s.energy().kinetic == 0);
  CHECK(s.energy().external == Approx(0).margin(1e-12 * expected));
  CHECK(s.energy().external_peak == Approx(expected).epsilon(1e-12));
}
