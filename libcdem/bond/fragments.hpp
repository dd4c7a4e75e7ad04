// Which nodes unbroken bonds hold together.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// One of the three bonds of the face, at least, has not lost its strength.
bool is_bonded(const State&, std::int64_t batch, int lane);

// For each node, the smallest node of its piece (n_nodes). Union-find joins nodes over bonded faces, over unbroken bonds
// between blocks, and over shared nodes.
std::vector<int> fragments_of_nodes(const Model&, const State&);

} // namespace cdem
