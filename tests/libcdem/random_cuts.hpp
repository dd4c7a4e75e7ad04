// Blocks cut by random planes, through the one door for changes of topology (fracture/rebuild.hpp).
#pragma once

#include "tests/libcdem/system.hpp"

namespace testing {

int largest_block(const cdem::Model&);
std::vector<int> all_blocks(const cdem::Model&);

// Each of the blocks in two, by a plane of random direction through its centroid (shifted clear of its
// vertices as refine does). Conditions stay.
void cut_at_random(System&, const std::vector<int>& blocks, std::uint64_t seed);

} // namespace testing
