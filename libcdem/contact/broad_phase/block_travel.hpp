// How fast blocks move.
#pragma once

#include "libcdem/contact/data/contact_work.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// m/s, per block, of its fastest node.
std::vector<double> speeds_of_blocks(const Model&, const State&, const ContactWork&, int threads);

} // namespace cdem
