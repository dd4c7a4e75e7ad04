// Whether a State that was read belongs to its model: what is read may be forged, and its checksum with it.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

// Throws InputError naming the field where an array has another length than its model asks for, or where an index or a
// mode is out of range.
void require_fits(const Model&, const State&);

} // namespace cdem
