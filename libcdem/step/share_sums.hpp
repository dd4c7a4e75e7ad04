// What the chunks of each rank leave for the sums and the log of a step, told to all: afterwards the workspace holds that
// of all chunks, as if this rank had computed them, and they are added in their order.
#pragma once

#include "libcdem/fracture/begin_cracks.hpp"
#include "libcdem/step/workspace.hpp"

namespace cdem {

// Does nothing where one rank computes all.
void share_sums(Workspace&, BegunCracks&);

} // namespace cdem
