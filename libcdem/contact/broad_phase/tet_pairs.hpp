// Finds the pairs of tetrahedra of one block that may touch before any of them has left its skin.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Whether contact within the block goes by pairs of its tetrahedra: faces of it have broken.
bool touches_itself(const Model&, const ContactFragments&, int block);

// In this step overlaps without a force that have grown smaller count as they are now, and pairs that have parted are forgotten. Not
// in steps that are looked over.
inline bool forgets_overlaps(const State& state, const ContactWork& work) {
  constexpr std::int64_t every = 20, first = 10;
  return work.step > 0 && state.step % every == first;
}

// Writes ContactWork::tet_contacts, null where no block touches itself with broken faces. told: contact has just been told of
// bonds, and has found fragments.
void find_tet_pairs(const Model&, const State&, ContactWork&, bool told);

// Goes on with the pairs of before, also where nodes have been freed or joined: tetrahedra keep their numbers, and only those of
// joined nodes have moved. Null: none were known.
void take_tet_pairs(const Model&, const State&, std::shared_ptr<TetContacts> before, ContactWork&);

} // namespace cdem
