// Row sums of |K| of the tetrahedra of one convex block: a Gershgorin bound of its stiffness.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// N/m (n_nodes of the block), of each node the largest of its three rows; for blocks of few nodes.
std::vector<double> star_row_sums(const Model&, const Block&);

} // namespace cdem
