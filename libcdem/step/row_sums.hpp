// Gershgorin bound of the stiffness: row sums of |K| of blocks, meshes and springs.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

std::vector<double> all_row_sums(const Model&); // N/m (n_nodes), of each node the largest of its three rows

} // namespace cdem
