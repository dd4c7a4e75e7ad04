// Pieces of a model that unbroken bonds hold together.
#pragma once

#include "libcdem/load/resolve.hpp"
#include "libcdem/results/fragment.hpp"

namespace cdem {

// Fragments as in bond/fragments.hpp, largest first; equal ones in the order of their first node.
std::vector<Fragment> fragments(const Model&, const State&, const ResolvedConditions&);

// The rank by volume of each node's fragment, from 1, largest first. 0 where all bodies of the fragment are in one piece,
// such as a floor on which others shatter.
std::vector<int> fragment_ranks(const Model&, const State&);

} // namespace cdem
