// Which nodes unbroken bonds hold together.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// All three bonds of the face are whole, and no cohesive law acts on it.
bool is_untouched(const State&, std::int64_t batch, int lane);

// Of each node, the smallest node of its piece (n_nodes): union-find over the faces on which at least one bond is
// whole, or over those that are untouched, over the unbroken bonds between blocks, and over shared nodes.
enum class Joins { any_bond, untouched };
std::vector<int> fragments_of_nodes(const Model&, const State&, Joins = Joins::any_bond);

} // namespace cdem
