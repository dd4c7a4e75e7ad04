// Motion of blocks as wholes, for the restitution of contacts. Restitution depends on whether two bodies approach, not
// on waves at their surfaces. Each block has the velocity of its centroid and the spin that correspond to its momentum
// and angular momentum.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Writes ContactWork::block_forces and block_stiffness, of State::contacts.
void sum_block_forces(const Model&, const State&, ContactWork&);

// 1/s, omega of contact_law.hpp, of two blocks that touch each other, by these sums.
double frequency_on_contacts(const Model&, const ContactWork&, int block_a, int block_b);

// Writes ContactWork::block_motion. A block with broken faces has none: its fragments move by themselves.
void find_block_motions(const Model&, const State&, ContactWork&, int threads);

} // namespace cdem
