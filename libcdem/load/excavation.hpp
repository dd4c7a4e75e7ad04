// Excavation by degrees (convergence-confinement, Panet and Guenot 1982). Removed rock leaves behind the forces F that it
// gave to the nodes of the rock that stays: loads
//
//   f = (1 - lambda) F
//
// keep everything as it was at lambda = 0, and nothing of them is left at lambda = 1. They keep their direction and do
// not follow the nodes.
#pragma once

#include "libcdem/load/excavation_options.hpp"
#include "libcdem/load/resolve.hpp"

namespace cdem {

// The loads of State::excavation.
void add_excavations(const State&, ResolvedConditions&);

// Forces that act in full until now, and then go as told. force: N (n_nodes).
void keep_forces(const std::vector<Node>& force, const Excavation&, State&);

// The forces that are kept go on to `relaxed` from now on. Returns how many have further to go.
std::size_t relax_forces(const Excavation&, State&);

} // namespace cdem
