// Springs that do nothing any more: those of interfaces that are left to contact, where no water presses. A step passes by
// them.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

struct BondWork;

// All empty where no interface turns.
struct IdleSprings {
  std::vector<char> batch; // of SpringBatches::springs: all of them are idle
  std::vector<char> block; // of Model::blocks: no spring acts on it
};

// Writes BondWork::idle, and sets the forces of idle springs to 0.
void find_idle_springs(const Model&, const State&, BondWork&);

} // namespace cdem
