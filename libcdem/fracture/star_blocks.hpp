// Joined blocks without zones: regions of a cohesive mesh that only borders between them may part, all tets of each of which
// meet in one node. The stress of their tets does not see bending: by symmetry the two at a face have no normal strain
// there, and the moment passes through the tets beside them.
#pragma once

#include "libcdem/model/model.hpp"

#include <vector>

namespace cdem {

struct StarBlocks {
  std::vector<int> of_tet;   // per tet of the mesh: its block; -1: none of these; empty: there are none
  std::vector<double> shape; // of each, the least extent in any direction over the largest
};
StarBlocks star_blocks(const Model&);

} // namespace cdem
