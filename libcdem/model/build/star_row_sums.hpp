// Row sums of |K| of the tetrahedra of one convex block: a Gershgorin bound of its stiffness.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// N/m, of each node the largest of its three rows; tets: over nodes (m), which are few.
std::vector<double> star_row_sums(const Elastic&, const std::vector<geom::Vec3>& nodes,
                                  const std::vector<geom::Tet>& tets);
std::vector<double> star_row_sums(const Model&, const Block&); // (n_nodes of the block)

} // namespace cdem
