// Units in a field of water: blocks of one body that interfaces join.
#pragma once

#include "libcdem/load/resolve.hpp"

namespace cdem {

// Which units the water accelerates as wholes, what their cavities are, and how long the answers of the field hold.
// shells: of_inner_shells.
void find_units_in_water(const Model&, const std::vector<int>& shells, ResolvedFlow&);

} // namespace cdem
