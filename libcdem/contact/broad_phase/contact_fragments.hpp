// Which fragments there are, and what holds them together.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/contact/geometry/nearest.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

void find_contact_fragments(const Model&, const State&, ContactFragments&);

// Whether a fragment of a broken block is more than a single tet. number: its own; -1: a whole block, which is no such fragment.
inline bool of_several_tets(const ContactFragments& fragments, int number) {
  return number >= 0 && fragments.triangles_of_tet[number][0] < 0;
}

// Bonds hold its tets together: cracks may end in it, and its surface need not be closed.
inline bool held_by_bonds(const ContactFragments& fragments, int number) {
  return of_several_tets(fragments, number) && !fragments.one_piece[number];
}

// By how much edges of a target's triangles that lie on each other may part, over the height of a tet: where bonds hold its
// tets together, as much as these open.
inline double gives_of(const Model& model, const ContactWork& work, int block, int number) {
  return (number < 0 || !work.fragments.one_piece[number]) && has_bonds(model, block)
             ? work.sizes.bonds_give[block]
             : same_place_at_least;
}

} // namespace cdem
