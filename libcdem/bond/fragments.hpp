// Which nodes unbroken bonds hold together.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// All three bonds of the face are whole: those that soften are until they have lost all their strength.
bool is_untouched(const State&, std::int64_t batch, int lane);

// One of the three bonds of the face, at least, has not lost its strength.
bool is_bonded(const State&, std::int64_t batch, int lane);

inline ToldOfBonds told_of(const State& state, int frame) {
  return static_cast<ToldOfBonds>(state.told_bonds[static_cast<std::size_t>(frame)]);
}
// State::told_bonds says of all interfaces that turn what is so.
bool all_bonds_are_told(const Model&, const State&);
// Writes FaceStateBatch::told of the faces, and State::told_bonds of the interfaces, of these blocks (per block).
void tell_of_bonds(const Model&, State&, const std::vector<char>& blocks);

// For each node, the smallest node of its piece (n_nodes). Union-find joins nodes over faces with at least one whole
// bond (or over faces that contact has not been told to be broken), over bonds between blocks, unbroken or not told to
// be so, and over shared nodes.
enum class Joins { any_bond, told };
std::vector<int> fragments_of_nodes(const Model&, const State&, Joins = Joins::any_bond);

} // namespace cdem
