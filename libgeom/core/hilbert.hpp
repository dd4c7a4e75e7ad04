// Places along a Hilbert curve (Skilling 2004, "Programming the Hilbert curve"): neighbours along it are neighbours in
// space.
#pragma once

#include "libgeom/core/types.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace geom {

// Distance along the curve through a grid of 2^21 cells in each axis.
std::uint64_t hilbert_index(std::array<std::uint32_t, 3> cell);

// Indices of `places` in the order in which the curve through `box` meets them (n_places). The same on every machine;
// places in one cell keep their order.
std::vector<int> along_hilbert_curve(const std::vector<Vec3>& places, const Box& box);

} // namespace geom
