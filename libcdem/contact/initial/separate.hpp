// Checks that blocks do not occupy the same space. Springs act on faces that meet, so blocks that overlap would pass
// through each other without a force.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// Throws geom::InputError naming the bodies and the place when two blocks share a volume.
void require_separate(const Model&);

} // namespace cdem
