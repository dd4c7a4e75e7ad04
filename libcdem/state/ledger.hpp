// Energy ledger, J. Stored terms are functions of the state; the others are summed as they happen.
#pragma once

namespace cdem {

struct EnergyLedger {
  // stored
  double elastic = 0; // blocks, sum V sigma : eps / 2
  double springs = 0; // bonds and contacts, sum F^2 / 2K
  double bolts = 0;   // steel and grout, sum F^2 / 2K
  double kinetic = 0; // real masses, or the fictitious ones of a relaxation
  // spent
  double damping = 0;
  double radiated = 0; // by the dashpots of quiet boundaries and free fields
  double friction = 0;
  // Stored in a spring when it broke and no longer stored after; damage of softening bonds.
  double breaking = 0;
  double plastic = 0;    // plastic work of blocks that yield
  double yielding = 0;   // of the steel of bolts
  double cutting = 0;    // stored and kinetic energy lost when blocks are cut or removed, or nodes joined
  double fictitious = 0; // kinetic energy thrown away when a relaxation ends or its masses are rebuilt
  // given
  double external = 0;      // work of loads, gravity and moving supports
  double external_peak = 0; // largest |external| so far

  // What is too little to be told from rounding: the least that `scale` is; written by energy().
  double least = 0;

  double total() const {
    return elastic + springs + bolts + kinetic + damping + radiated + friction + breaking + plastic +
           yielding + cutting + fictitious;
  }
  // The largest entry, J: what errors are measured against. A free body has external work for its first velocity alone,
  // rock that gives way from its initial stress spends more than the loads give.
  double scale() const;
  double balance_error() const; // |total - external| over scale; 0 before anything happened
};

// A balance that is open by more than this says that the solution is not to be trusted.
inline constexpr double open_balance = 0.01, broken_balance = 0.1;

} // namespace cdem
