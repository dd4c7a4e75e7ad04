// Joints of their own for the faces inside a region of a mesh, or between two.
#pragma once

#include "libcdem/joint/joint.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace cdem {

struct RegionLaws {
  std::vector<Joint> joints;
  std::vector<std::pair<int, int>> regions; // of each: from 0, the smaller first; twice the same: inside it

  std::vector<int> by_regions; // their numbers by `regions`; written by sort, once all are there

  bool empty() const { return joints.empty(); }
  void sort() {
    by_regions.resize(regions.size());
    std::iota(by_regions.begin(), by_regions.end(), 0);
    std::stable_sort(by_regions.begin(), by_regions.end(),
                     [&](int x, int y) { return regions[x] < regions[y]; });
  }
  // Into `joints`; -1: these faces have the body's joint.
  int between(int a, int b) const {
    const std::pair<int, int> wanted = std::minmax(a, b);
    const auto found =
        std::lower_bound(by_regions.begin(), by_regions.end(), wanted,
                         [&](int law, const std::pair<int, int>& of) { return regions[law] < of; });
    return found == by_regions.end() || regions[*found] != wanted ? -1 : *found;
  }
};

} // namespace cdem
