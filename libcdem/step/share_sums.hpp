// Sends the contributions of each rank's faces and springs to the sums and the log of a step to all ranks. Afterwards
// the workspace holds the contributions of all chunks, as if this rank had computed them, and they are added in the
// order of chunks. Most chunks contribute nothing, and only the others are sent. Sums over nodes, which all chunks
// have, are added by the ranks (step_loops.cpp, sums_of).
#pragma once

#include "libcdem/fracture/begin_cracks.hpp"
#include "libcdem/step/workspace.hpp"

namespace cdem {

// Whether this rank has anything to tell.
bool has_to_tell(const Workspace&, const BegunCracks&);

// The reliefs of all ranks, for all; a rank needs those of the tets that it computes or reads.
void share_reliefs(BegunCracks&);

// tellers: of how many ranks that is so.
void share_sums(Workspace&, BegunCracks&, std::int64_t tellers);

// NearStrength::bits of all ranks. Taken from others, nothing is known of their tets in the steps to come.
std::vector<std::uint8_t> near_of_all_ranks(const Workspace&);
void take_near_of_all(std::vector<std::uint8_t>, Workspace&);

} // namespace cdem
