// Large arrays of a Model that ranks on one machine share: one of them writes the arrays to a file without a name, and each
// maps that file in place of the pages of its own that its share does not need. The arrays keep their addresses and their
// values; pages of other ranks' data are read from the one copy in the machine's page cache, which the system may drop
// and read again. A page that is written becomes the rank's own, as before.
//
// If the temporary folder is in memory (tmpfs) or full, nothing is parked and all pages stay.
#pragma once

#include "libcdem/ranks/state_shares.hpp"

namespace cdem {

// Does nothing for a model that is parked already, or small. All ranks call it together.
void park(const Model&, const StateShares&);

} // namespace cdem
