// A watch goes on where blocks have been taken out of the model.
#pragma once

#include "libcdem/results/watch.hpp"

namespace cdem {

// new_block: the number that each block has now, -1 of those that are gone; no unit of the watch is.
void carry_over(Watch&, const std::vector<int>& new_block);

} // namespace cdem
