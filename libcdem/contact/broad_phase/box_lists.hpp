// Two lists of boxes: which of one meet which of the other.
#pragma once

#include "libcdem/contact/geometry/positions.hpp"
#include "libgeom/query/box_pairs.hpp"

namespace cdem {

// take(i, j) for every box of `one`, grown by `by`, that meets one of `other`: in order of i, then j.
template <class Take>
void each_meeting(const std::vector<geom::Box>& one, double by, const std::vector<geom::Box>& other,
                  const Take& take) {
  constexpr std::size_t most_pairs_by_hand = 40000; // more go through a grid
  if (one.size() * other.size() <= most_pairs_by_hand) {
    for (std::size_t i = 0; i < one.size(); ++i) {
      const geom::Box box = grown(one[i], by);
      for (std::size_t j = 0; j < other.size(); ++j)
        if (!apart(box, other[j]))
          take(i, j);
    }
    return;
  }
  std::vector<geom::Box> boxes;
  boxes.reserve(one.size() + other.size());
  for (const geom::Box& box : one)
    boxes.push_back(grown(box, by));
  boxes.insert(boxes.end(), other.begin(), other.end());
  for (const auto& [i, j] : geom::touching_pairs(boxes))
    if (static_cast<std::size_t>(i) < one.size() && static_cast<std::size_t>(j) >= one.size())
      take(static_cast<std::size_t>(i), static_cast<std::size_t>(j) - one.size());
}

} // namespace cdem
