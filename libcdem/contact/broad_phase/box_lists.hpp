// Two lists of boxes: which of one meet which of the other.
#pragma once

#include "libcdem/contact/geometry/positions.hpp"
#include "libgeom/query/box_pairs.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

// take(i, j) for every box of `one`, grown by `by`, that meets one of `other`: in order of i, then j.
template <class Take>
void each_meeting(const std::vector<geom::Box>& one, double by, const std::vector<geom::Box>& other,
                  const Take& take) {
  constexpr std::size_t few = 256, many = 1000000; // pairs
  if (one.size() * other.size() <= few) {
    for (std::size_t i = 0; i < one.size(); ++i) {
      const geom::Box box = grown(one[i], by);
      for (std::size_t j = 0; j < other.size(); ++j)
        if (!apart(box, other[j]))
          take(i, j);
    }
    return;
  }
  if (one.size() * other.size() <=
      many) { // by where they begin along the axis along which they reach the furthest
    geom::Box all;
    geom::Vec3 longest = geom::Vec3::Zero();
    for (const geom::Box& box : other) {
      all.extend(box.min);
      all.extend(box.max);
      longest = longest.cwiseMax(box.max - box.min);
    }
    int axis = 0;
    (all.max - all.min).maxCoeff(&axis);
    constexpr double rounding = 1e-12;
    const double before =
        longest[axis] + rounding * (std::abs(all.min[axis]) + std::abs(all.max[axis])); // of a begin
    std::vector<std::pair<double, std::size_t>> begins;
    begins.reserve(other.size());
    for (std::size_t j = 0; j < other.size(); ++j)
      begins.emplace_back(other[j].min[axis], j);
    std::sort(begins.begin(), begins.end());
    std::vector<std::size_t> meet;
    for (std::size_t i = 0; i < one.size(); ++i) {
      const geom::Box box = grown(one[i], by);
      meet.clear();
      for (auto b = std::lower_bound(begins.begin(), begins.end(),
                                     std::pair(box.min[axis] - before, std::size_t{0}));
           b != begins.end() && b->first <= box.max[axis]; ++b)
        if (!apart(box, other[b->second]))
          meet.push_back(b->second);
      std::sort(meet.begin(), meet.end());
      for (const std::size_t j : meet)
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
