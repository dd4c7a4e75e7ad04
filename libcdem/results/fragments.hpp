// Pieces of a model that unbroken bonds hold together.
#pragma once

#include "libcdem/load/resolve.hpp"
#include "libcdem/results/fragment.hpp"

namespace cdem {

// Union-find over the faces on which at least one bond is whole, and over shared nodes. Largest first; equal ones in
// the order of their first node.
std::vector<Fragment> fragments(const Model&, const State&, const ResolvedConditions&);

// Of each node, the smallest node of its piece (n_nodes).
std::vector<int> pieces_of_nodes(const Model&, const State&);

} // namespace cdem
