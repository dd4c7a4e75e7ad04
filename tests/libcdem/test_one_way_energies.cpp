// Energies that no solution can show, whether or not the balance closes.
#include "libcdem/results/one_way_energies.hpp"

#include <catch2/catch.hpp>

TEST_CASE("energies that cannot be are told of where the balance closes", "[energy]") {
  cdem::EnergyLedger ledger;
  ledger.external = ledger.external_peak = 100;
  cdem::OneWayEnergies seen;
  double time = 0;
  const auto step = [&](double kinetic, double friction, double breaking) {
    ledger.kinetic = kinetic;
    ledger.friction = friction;
    ledger.breaking = breaking;
    seen.look(ledger, ++time);
    return cdem::impossible_energy(ledger, time, seen);
  };
  SECTION("nothing is wrong") {
    CHECK(step(100, 0, 0).energy == 0);
    CHECK(step(70, 10, 20).energy == 0);
    CHECK(step(65, 15, 20).energy == 0);
  }
  SECTION("breaking returns what friction takes") {
    step(60, 10, 30);
    const cdem::ImpossibleEnergy found = step(60, 30, 10);
    CHECK(ledger.balance_error() == 0);
    CHECK(found.energy == Approx(20));
    CHECK(found.part == Approx(0.2));
    CHECK(found.time == 2);
    CHECK_THAT(found.what, Catch::StartsWith("the energy of breaking"));
    CHECK(step(40, 30, 30).energy == Approx(20)); // remembered, with its time
    CHECK(step(40, 30, 30).time == 2);
  }
  SECTION("more moves than was given, for a moment") {
    CHECK(step(115, 5, -20).energy == Approx(20)); // breaking has fallen by more
    const cdem::ImpossibleEnergy found = step(60, 15, 25);
    CHECK(found.energy == Approx(20));
    seen.fallen = {};
    CHECK(cdem::impossible_energy(ledger, time, seen).energy == Approx(15));
    CHECK_THAT(cdem::impossible_energy(ledger, time, seen).what, Catch::StartsWith("kinetic and stored"));
  }
  SECTION("more moves than was given, and the balance says so") {
    const cdem::ImpossibleEnergy found = step(130, 10, 0);
    CHECK(ledger.balance_error() == Approx(40 / 130.0));
    CHECK(found.energy == Approx(30));
    CHECK_THAT(found.what, Catch::StartsWith("kinetic and stored"));
  }
}

TEST_CASE("an energy balance is measured against the largest energy", "[energy]") {
  cdem::EnergyLedger ledger;
  CHECK(ledger.balance_error() == 0);
  ledger.kinetic = 200; // of a free body that nobody pushed
  CHECK(ledger.balance_error() == 1);
  ledger.external = ledger.external_peak = 190;
  CHECK(ledger.balance_error() == Approx(0.05));
  ledger.kinetic = ledger.external = ledger.external_peak = 1e-15;
  ledger.springs = 1e-14;
  ledger.least = 1e-9;
  CHECK(ledger.balance_error() == Approx(1e-5)); // rounding of a structure at rest
  ledger.external_peak = 1e3;
  CHECK(ledger.balance_error() == Approx(1e-17));
}
