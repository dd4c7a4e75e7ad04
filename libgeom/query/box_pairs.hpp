// Broad phase: which boxes touch which.
#pragma once

#include "libgeom/core/types.hpp"

#include <functional>
#include <utility>

namespace geom {

inline bool touch(const Box& a, const Box& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

// Pairs (i < j) of boxes that overlap or touch, sorted. Found on a uniform grid filled by a counting sort:
// the cost grows with the number of boxes and pairs. When `wanted` is not empty, only pairs with at least one
// wanted box; with `counts`, only pairs for which it is true.
std::vector<std::pair<int, int>> touching_pairs(const std::vector<Box>& boxes,
                                                const std::vector<char>& wanted = {},
                                                const std::function<bool(int, int)>& counts = {});

} // namespace geom
