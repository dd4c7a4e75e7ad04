// The ledger of a state: stored energies computed from it, spent ones as summed by the steps.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// kinetic: J, of real masses (a relaxation ends at rest).
EnergyLedger energy(const Model&, const State&);

double kinetic_energy(const Model&, const State&); // J, of nodes and rigid bodies

// m/s (n_blocks): sqrt(2 E / m) of each block's kinetic energy and mass, so that what turns on the spot moves too.
std::vector<double> speeds_of_blocks(const Model&, const State&);

// J, sum V (sigma0 : eps + eps : C : eps / 2), `lag` seconds ago with the present velocity.
double elastic_energy(const Model&, const State&, double lag = 0);

} // namespace cdem
