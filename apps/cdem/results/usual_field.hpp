// The field to colour by where the user names none.
#pragma once

#include "libcdem/results/snapshot.hpp"

#include <string>

namespace cdem::app {

// "displacement.magnitude"; of a mesh, which has no displacement, its region; else the first scalar of the cells, or "".
std::string usual_field(const Snapshot&);

} // namespace cdem::app
