// Finds the pairs of tetrahedra of one block that may touch before any of them has left its skin.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Blocks that touch themselves, once faces of them have broken.
bool touches_itself(const Model&, const ContactWork&, int block);

// Writes ContactWork::tet_contacts, null where no block does. Contact has been told of bonds.
void find_tet_pairs(const Model&, const State&, ContactWork&);

// m, of the block: the skin around each of its tetrahedra.
bool pairs_left_skin(const ContactWork&);

// Writes where the nodes are and how far the tetrahedra have gone in the step.
void move_tets(const Model&, const State&, ContactWork&);

} // namespace cdem
