#include "libgeom/query/box_pairs.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace geom {
namespace {

using Cell = Eigen::Vector3i;

struct Grid {
  Vec3 origin;
  double cell; // edge length, m
  Cell count;

  Cell of(const Vec3& x) const {
    Cell c;
    for (int axis = 0; axis < 3; ++axis)
      c[axis] = std::clamp(static_cast<int>((x[axis] - origin[axis]) / cell), 0, count[axis] - 1);
    return c;
  }
  std::size_t index(const Cell& c) const {
    return (static_cast<std::size_t>(c.z()) * count.y() + c.y()) * count.x() + c.x();
  }
  template <typename Visit>
  void for_each(const Cell& low, const Cell& high, Visit visit) const {
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x)
          visit(index({x, y, z}));
  }
};

// Cells of about the mean box, coarsened until neither the cells nor their entries outnumber the boxes by
// far.
Grid make_grid(const std::vector<Box>& boxes, const std::vector<int>& members) {
  Box all;
  double mean = 0;
  for (int i : members) {
    all.extend(boxes[i].min);
    all.extend(boxes[i].max);
    mean += boxes[i].size().maxCoeff() / static_cast<double>(members.size());
  }
  Grid grid{all.min, std::max(mean, 1e-9 * all.size().maxCoeff()), Cell::Ones()};
  if (!(grid.cell > 0))
    grid.cell = 1; // all boxes are one point
  for (;; grid.cell *= 1.5) {
    const double limit = 64 + 32 * static_cast<double>(members.size());
    const Vec3 cells = (all.size() / grid.cell).array().floor() + 1;
    double entries = 0;
    for (int i : members)
      entries += ((boxes[i].size() / grid.cell).array() + 1).prod();
    if (cells.prod() <= limit && entries <= limit) {
      grid.count = cells.cast<int>();
      return grid;
    }
  }
}

} // namespace

std::vector<std::pair<int, int>> touching_pairs(const std::vector<Box>& boxes,
                                                const std::vector<char>& wanted,
                                                const std::function<bool(int, int)>& counts) {
  assert(wanted.empty() || wanted.size() == boxes.size());
  const auto is_wanted = [&](int i) { return wanted.empty() || wanted[i]; };
  Box region;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (is_wanted(static_cast<int>(i))) {
      region.extend(boxes[i].min);
      region.extend(boxes[i].max);
    }
  std::vector<int> members; // the others cannot touch a wanted box
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (touch(boxes[i], region))
      members.push_back(static_cast<int>(i));
  std::vector<std::pair<int, int>> pairs;
  if (members.empty())
    return pairs;

  const Grid grid = make_grid(boxes, members);
  std::vector<int> start(static_cast<std::size_t>(grid.count.prod()) + 1, 0);
  for (int i : members)
    grid.for_each(grid.of(boxes[i].min), grid.of(boxes[i].max), [&](std::size_t c) { ++start[c + 1]; });
  for (std::size_t c = 1; c < start.size(); ++c)
    start[c] += start[c - 1];
  std::vector<int> entry(start.back()), fill(start.begin(), start.end() - 1);
  for (int i : members)
    grid.for_each(grid.of(boxes[i].min), grid.of(boxes[i].max), [&](std::size_t c) { entry[fill[c]++] = i; });

  for (std::size_t c = 0; c + 1 < start.size(); ++c)
    for (int k = start[c]; k < start[c + 1]; ++k)
      for (int l = k + 1; l < start[c + 1]; ++l) {
        const int i = entry[k], j = entry[l]; // i < j, as members are in order
        if (!(is_wanted(i) || is_wanted(j)) || !touch(boxes[i], boxes[j]))
          continue;
        // Boxes that meet in several cells count in the one that holds the lower corner of their common part.
        if (grid.index(grid.of(boxes[i].min.cwiseMax(boxes[j].min))) == c && (!counts || counts(i, j)))
          pairs.emplace_back(i, j);
      }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

} // namespace geom
