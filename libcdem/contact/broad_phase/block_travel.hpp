// How fast blocks move, and how far.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// m/s, per block, of its fastest node.
std::vector<double> speeds_of_blocks(const Model&, const State&, const ContactWork&, int threads);

// Writes BlockTravel::last_displacement, of the step that is as long as ContactWork::step.
void set_displacements(const Model&, const State&, ContactWork&, int threads);

} // namespace cdem
