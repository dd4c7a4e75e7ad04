// Disjoint sets of 0 .. n - 1 by path halving; the smallest member represents its set.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace geom {

class DisjointSets {
public:
  explicit DisjointSets(std::size_t members) : parent_(members) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(int a, int b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<int> parent_;
};

} // namespace geom
