// Gershgorin bound of the stiffness: row sums of |K| of blocks, meshes and springs, and the stable step of a node by it.
//
// Velocities stand half a step behind: v <- v - dt (c v + k x), x <- x + dt v is stable while k dt^2 + 2 c dt <= 4.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// N/m (n_nodes), of each node the largest of its three rows. Of elements and the faces of meshes; and of springs too.
std::vector<double> element_row_sums(const Model&);
std::vector<double> all_row_sums(const Model&);
// For the same model with more or fewer nodes freed: only rows near these tets (of the model) are other ones. The next call of the
// two above finds its answer. old_node: per node, which it was before.
void renew_row_sums(const Model& before, const Model& now, const std::vector<int>& old_node,
                    const std::vector<int>& tets);

// s; frequency2: 1/s2, row sum of |K| over mass; rate: 1/s, the same of what is damped, times beta.
double stable_time_step(double frequency2, double rate);

double damping_of(const Model&, int node); // s, the largest beta of its material and the joints at it

} // namespace cdem
