// Broken faces of a mesh: how they turn, slide, take energy, and when they are let go.
#include "tests/libcdem/two_halves.hpp"

#include "libcdem/bond/leaving_faces.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/step/errors.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

const double size_of_face = std::sqrt(area / 2); // m

// As with a contact of the body with itself, but nothing to meet: what the faces let go is free.
void cover(System& s) {
  s.model.surface.joint[{0, 0}] = 0;
  s.model.surface.block_begin.assign(2, 0);
}

// The upper half thrown along the plane, pressed on the lower one.
System thrown(double speed) {
  System s(build({meshed("unit", two_halves(2), between_halves(), rock(), halves_joint(false))}));
  const std::vector<char> upper = upper_nodes(s.model);
  for (std::size_t i = 0; i < upper.size(); ++i)
    s.state.velocity[i].x = upper[i] ? speed : 0;
  s.hold(cdem::Selection::side("z-"), "xyz");
  s.conditions.tractions = {traction(cdem::Selection::side("z+"), {0, 0, -1e6})};
  return s;
}

cdem::RunOptions steps(std::int64_t n) {
  cdem::RunOptions options;
  options.steps = n;
  return options;
}

} // namespace

TEST_CASE("broken faces: what friction holds turns with the face, about its normal too", "[bonds][mesh]") {
  const bool bonded = GENERATE(false, true);
  const auto [axis, angle] =
      GENERATE(std::make_pair(Vec3(0, 0, 1), 90 * degree), std::make_pair(Vec3(1, -2, 0.5), 140 * degree));
  Halves halves(halves_joint(bonded));
  halves.go({0, 0, 2e6});                            // breaks
  halves.go({3e6, 1e6, -2e6});                       // slides
  const Vec3 before = halves.go({2e6, 1.5e6, -2e6}); // is held
  REQUIRE(std::hypot(before.x(), before.y()) < 0.9 * std::tan(35 * degree) * 2e6);
  REQUIRE(std::hypot(before.x(), before.y()) > 1e5);
  halves.turn(rotation(axis, angle));
  CHECK((halves.go({2e6, 1.5e6, -2e6}) - before).norm() < 1e-9 * before.norm());
}

TEST_CASE("broken faces: parted or slid away they are handed over to the contact of the surface",
          "[bonds][mesh]") {
  const bool covered = GENERATE(true, false);
  const double limit = cdem::slid_from * size_of_face, open = cdem::parted_from * size_of_face,
               off = cdem::slid_off_from * size_of_face;
  Halves halves(halves_joint());
  if (covered)
    cover(halves.system);
  const Vec3 press(0, 0, -1e-6);
  halves.go({0, 0, 2e6});
  SECTION("parted") {
    halves.lead({0, 0, 0.99 * open});
    CHECK(halves.handed_over() == 0);
    CHECK(halves.lead(press).norm() > 0);
    halves.lead({0, 0, 1.01 * open});
  }
  SECTION("slid away") {
    CHECK(halves.lead(press + Vec3(0.99 * limit, 0, 0)).norm() > 0);
    CHECK(halves.handed_over() == 0);
    // Contacts may begin, and its springs let go of it little by little.
    CHECK(halves.lead(press + Vec3(1.01 * limit, 0, 0)).norm() > 0);
    const double slides = halves.lead(press + Vec3(0.3 * off + 0.7 * limit, 0, 0)).norm();
    halves.lead(press + Vec3(0.3 * off + 0.7 * limit, 0, 0));
    CHECK(halves.lead(press + Vec3(0.7 * off + 0.3 * limit, 0, 0)).norm() <= slides);
    halves.lead(press + Vec3(1.01 * off, 0, 0));
  }
  CHECK(halves.handed_over() == (covered ? 2 : 0));
  CHECK((halves.lead(press).norm() > 0) == !covered);
}

TEST_CASE("broken faces: intact ones are never handed over", "[bonds][mesh]") {
  cdem::Joint strong = halves_joint();
  strong.cohesion = strong.tensile_strength = 1e15;
  Halves halves(strong);
  cover(halves.system);
  CHECK(halves.lead({0.5 * size_of_face, 0, 0.1 * size_of_face}).norm() > 1e9);
  CHECK(halves.handed_over() == 0);
}

TEST_CASE("broken faces: a run ends where pieces slide past their faces and nothing takes over",
          "[errors][mesh]") {
  System s = thrown(50);
  try {
    s.run(steps(5000));
    FAIL("went on");
  } catch (const cdem::SolutionError& e) {
    CHECK_THAT(e.what(), Catch::Contains("slid past each other by more than its size, 0.212 m") &&
                             Catch::Contains("contacts = { {\"unit\", \"unit\", cdem.coulomb{...}} }"));
  }
  // Not before a corner has gone that far: 0.212 m at less than 50 m/s.
  CHECK(s.state.time > 0.212 / 50);
  CHECK(s.state.time < 1.3 * 0.212 / 50);
}

TEST_CASE("broken faces: handed over the piece flies on freely, the energy of the springs booked",
          "[energy][mesh]") {
  System s = thrown(50);
  s.conditions.tractions.clear();
  cover(s);
  s.run(steps(3000));
  const std::vector<char> upper = upper_nodes(s.model);
  double mass = 0, momentum = 0, moved = 1;
  for (std::size_t i = 0; i < upper.size(); ++i)
    if (upper[i]) {
      mass += s.model.node_mass[i];
      momentum += s.model.node_mass[i] * s.state.velocity[i].x;
      moved = std::min(moved, s.state.displacement[i].x);
    }
  CHECK(moved > 0.5);
  CHECK(momentum / mass == Approx(50).epsilon(1e-9));
}

TEST_CASE("broken faces: friction, breaking and unbonding are booked to where the balance closes",
          "[energy][mesh]") {
  SECTION("sliding to and fro: what is put in") {
    System s(build({meshed("unit", two_halves(2), between_halves(), rock(), halves_joint(false))}));
    s.hold(cdem::Selection::side("z-"), "xyz");
    cdem::Traction push;
    push.on = cdem::Selection::side("z+");
    push.stress = {1e6, 0.3e6, -1e6};
    push.amplitude = [](double t) { return t < 1e-3 ? 1.0 : std::cos(2 * pi * (t - 1e-3) / 2e-3); };
    s.conditions.tractions = {push};
    cdem::RunOptions options;
    options.duration = 4e-3;
    s.run(options);
    const cdem::EnergyLedger ledger = cdem::energy(s.model, s.state);
    INFO("friction " << ledger.friction << " of " << ledger.external_peak << " J, error "
                     << ledger.balance_error());
    CHECK(ledger.friction > 0.05 * ledger.external_peak);
    CHECK(ledger.balance_error() < 1e-5);
  }
  SECTION("torn apart") {
    System s(build({meshed("unit", two_halves(2), between_halves(), rock(), halves_joint())}));
    s.hold(cdem::Selection::side("z-"), "xyz");
    s.conditions.tractions = {traction(cdem::Selection::side("z+"), {0.3e6, 0, 1.2e6})};
    s.run(steps(600));
    REQUIRE(s.log.broken_tension + s.log.broken_shear == 24);
    const cdem::EnergyLedger ledger = cdem::energy(s.model, s.state);
    INFO("breaking " << ledger.breaking << " of " << ledger.external_peak << " J, error "
                     << ledger.balance_error());
    CHECK(ledger.breaking > 0);
    CHECK(ledger.balance_error() < 1e-5);
  }
  SECTION("unbonded under shear beyond what friction holds") {
    cdem::ModelSpec spec;
    cdem::Joint strong = halves_joint();
    strong.cohesion = strong.tensile_strength = 1e9;
    spec.bodies = {meshed("unit", two_halves(2), between_halves(), rock(), strong)};
    cdem::Simulation s(spec, 1, nullptr);
    s.fix(fixed(cdem::Selection::side("z-")));
    s.traction(traction(cdem::Selection::side("z+"), {2e6, 0, -1e6}));
    REQUIRE(s.relax({}).converged);
    s.break_bonds(cdem::Selection::on_plane(geom::Plane::through({0, 0, half}, {0, 0, 1})), true);
    const double cut = s.energy().cutting;
    CHECK(cut > 0);
    s.run(steps(1));
    const cdem::EnergyLedger ledger = s.energy();
    INFO("cutting " << cut << " J, friction " << ledger.friction << ", error " << ledger.balance_error());
    CHECK(ledger.friction < 0.2 * cut); // the drop of the force is in `cutting` alone
    CHECK(ledger.balance_error() < 1e-3);
  }
}
