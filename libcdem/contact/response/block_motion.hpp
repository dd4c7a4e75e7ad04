// Motion of blocks as wholes, for the restitution of contacts. Restitution depends on whether two bodies approach, not
// on waves at their surfaces. Each block has the velocity of its centroid and the spin that correspond to its momentum
// and angular momentum.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Writes ContactWork::block_forces, block_stiffness and pair_forces, of State::contacts.
void sum_block_forces(const Model&, const State&, ContactWork&);

// 1/s, omega of contact_law.hpp, of two blocks that touch each other, by these sums.
double frequency_on_contacts(const Model&, const ContactWork&, int block_a, int block_b);

// Two blocks of which one deforms and neither has broken faces: else their fragments move by themselves.
bool shares_friction(const Model&, const ContactWork&, int block_a, int block_b);

// Felt over usual forces of all contacts of two blocks that share friction.
double felt_over_usual(const ContactWork&, int block_a, int block_b);

// A block without broken faces: else its fragments move by themselves.
bool is_in_one_piece(const Model&, const ContactWork&, int block);

// By its nodes; not whole where they are too few for a spin.
BlockMotion motion_of(const Model&, const State&, const Block&);

// Writes ContactWork::block_motion. A block with broken faces has none: its fragments move by themselves.
void find_block_motions(const Model&, const State&, ContactWork&, int threads);

} // namespace cdem
