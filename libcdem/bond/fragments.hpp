// Which nodes unbroken bonds hold together.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// Of each node, the smallest node of its piece (n_nodes): union-find over the faces on which at least so many of the
// three bonds are whole, over the unbroken bonds between blocks, and over shared nodes.
std::vector<int> fragments_of_nodes(const Model&, const State&, int whole_bonds = 1);

} // namespace cdem
