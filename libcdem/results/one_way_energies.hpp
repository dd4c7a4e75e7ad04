// Energies that no solution can show. An energy balance may close all the same, where two errors hide each other in it.
//
//   1. damping, friction, breaking, plastic and yielding only rise: fall = (largest so far) - (now)
//   2. kinetic + stored <= given: surplus = (total - spent) - external, which is -(sum of 1) while the balance closes
//
// The rest of `total - spent`, radiated, cutting and fictitious, may have either sign and counts as energy that was there.
#pragma once

#include "libcdem/state/ledger.hpp"

#include <array>
#include <string>

namespace cdem {

struct OneWayEnergies {
  struct Fall {
    double energy = 0; // J, the largest so far, >= 0
    double time = 0;   // s, when
  };
  // In the order of one_way_names (one_way_energies.cpp); written by look.
  std::array<double, 5> largest{}; // J, so far, >= 0
  std::array<Fall, 5> fallen{};
  Fall surplus; // 2. after a step, while the balance closes

  // After every step. spent: its summed entries.
  void look(const EnergyLedger& spent, double time);
};

struct ImpossibleEnergy {
  std::string what;  // "breaking, which can only rise, fell": a sentence without its amount
  double energy = 0; // J, > 0; 0: nothing
  double time = 0;   // s, when
  double part = 0;   // of the largest entry of the ledger
  bool of_breaking = false;
};

// The largest of all. now, time: at present, with what is stored.
ImpossibleEnergy impossible_energy(const EnergyLedger& now, double time, const OneWayEnergies&);

} // namespace cdem
