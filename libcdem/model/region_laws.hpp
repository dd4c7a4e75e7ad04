// Joints of their own for the faces inside a region of a mesh, or between two.
#pragma once

#include "libcdem/joint/joint.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace cdem {

struct RegionLaws {
  std::vector<Joint> joints;
  std::vector<std::pair<int, int>> regions; // of each: from 0, the smaller first; twice the same: inside it

  bool empty() const { return joints.empty(); }
  // Into `joints`; -1: these faces have the body's joint.
  int between(int a, int b) const {
    const auto found = std::find(regions.begin(), regions.end(), std::pair<int, int>(std::minmax(a, b)));
    return found == regions.end() ? -1 : static_cast<int>(found - regions.begin());
  }
};

} // namespace cdem
