// What the pressure field stores, J, summed over the volume and not by the forces: for a cell with phi linear in it and each
// tetrahedron of the other body, R their common part,
//   U = K V0/V integral_R phi dV = K V0/V / (2 |g|^2) surface integral of phi^2 g . n dA,  g = grad phi,
// over the tetrahedron's faces in the cell and the cell's faces in the tetrahedron; with it the lines of sharp edges and the
// tangential springs. Costs far more than the forces: for the ledger, when somebody looks.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem::field {

// `lag` seconds before now, at the velocities of now; of blocks between which State::contacts has any. The tangential springs
// are taken as they are now.
double field_energy(const Model&, const State&, double lag);

} // namespace cdem::field
