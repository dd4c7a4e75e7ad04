// The log of a run as it was after an earlier step.
#pragma once

#include "libcdem/results/log.hpp"

namespace cdem {

// last_step: over all stages; there were so many breaks and these one-way energies then.
void go_back(RunLog&, std::int64_t last_step, std::size_t breaks, const OneWayEnergies&);

} // namespace cdem
