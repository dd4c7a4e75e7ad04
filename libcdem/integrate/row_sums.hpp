// Gershgorin bound of the stiffness: row sums of |K| of blocks, meshes and springs, and the stable step of a node by it.
//
// Velocities stand half a step behind: v <- v - dt (c v + k x), x <- x + dt v is stable while k dt^2 + 2 c dt <= 4.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// N/m (n_nodes), of each node the largest of its three rows. Of elements and the faces of meshes; and of springs too.
std::vector<double> element_row_sums(const Model&);
std::vector<double> all_row_sums(const Model&);

// s; frequency2: 1/s2, row sum of |K| over mass; rate: 1/s, the same of what is damped, times beta.
double stable_time_step(double frequency2, double rate);

double damping_of(const Model&, int node); // s, the largest beta of its material and the joints at it

} // namespace cdem
