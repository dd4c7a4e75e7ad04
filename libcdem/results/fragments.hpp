// Pieces of a model that unbroken bonds hold together.
#pragma once

#include "libcdem/load/resolve.hpp"
#include "libcdem/results/fragment.hpp"

namespace cdem {

// Fragments as in bond/fragments.hpp, largest first; equal ones in the order of their first node.
std::vector<Fragment> fragments(const Model&, const State&, const ResolvedConditions&);

} // namespace cdem
