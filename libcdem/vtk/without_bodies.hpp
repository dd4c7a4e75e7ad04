// A snapshot without some of its bodies: walls that would hide what is behind them.
#pragma once

#include "libcdem/results/snapshot.hpp"

#include <vector>

namespace cdem {

// Bodies by their number in cell field "body". Points, tetrahedra, faces, edges and fields of the others stay in
// their order; bonds all stay.
Snapshot without_bodies(const Snapshot&, const std::vector<int>& bodies);

} // namespace cdem
