#include "libcdem/load/inner_shells.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace cdem {
namespace {

// Triangles first to last of MeshData::boundary: those of one block, whose nodes may be several in one place.
class Shells {
public:
  Shells(const Model& model, int first, int last) : model_(model), first_(first), parent_(last - first) {
    std::iota(parent_.begin(), parent_.end(), 0);
    std::map<std::array<int, 2>, std::vector<int>> around; // an edge, by its vertices
    for (int t = 0; t < last - first; ++t) {
      const std::array<int, 3> corner = vertices(t);
      for (int i = 0; i < 3; ++i) {
        const int a = corner[i], b = corner[(i + 1) % 3];
        around[{std::min(a, b), std::max(a, b)}].push_back(t);
      }
    }
    open_.assign(parent_.size(), 0);
    for (const auto& [edge, triangles] : around)
      for (const int t : triangles) {
        parent_[root(t)] = root(triangles[0]);
        if (triangles.size() != 2)
          open_[t] = 1;
      }
  }

  void mark_inner(std::vector<int>& inner) {
    const auto n = static_cast<int>(parent_.size());
    std::vector<double> volume(n, 0); // six times, by root
    std::vector<char> open(n, 0);
    for (int t = 0; t < n; ++t) {
      const std::array<geom::Vec3, 3> x = corners(t);
      volume[root(t)] += x[0].dot(x[1].cross(x[2]));
      if (open_[t] != 0)
        open[root(t)] = 1;
    }
    for (int t = 0; t < n; ++t)
      inner[first_ + t] = volume[root(t)] < 0 && open[root(t)] == 0 ? first_ + root(t) + 1 : 0;
  }

private:
  std::array<geom::Vec3, 3> corners(int t) const { // about a place of the block
    const geom::Triangle& nodes = model_.mesh.boundary[first_ + t].nodes;
    const geom::Vec3& origin = model_.node_position[model_.mesh.boundary[first_].nodes[0]];
    return {model_.node_position[nodes[0]] - origin, model_.node_position[nodes[1]] - origin,
            model_.node_position[nodes[2]] - origin};
  }
  std::array<int, 3> vertices(int t) {
    std::array<int, 3> result{};
    const std::array<geom::Vec3, 3> x = corners(t);
    for (int i = 0; i < 3; ++i)
      result[i] = numbers_.try_emplace({x[i].x(), x[i].y(), x[i].z()}, static_cast<int>(numbers_.size()))
                      .first->second;
    return result;
  }
  int root(int t) {
    while (parent_[t] != t)
      t = parent_[t] = parent_[parent_[t]];
    return t;
  }

  const Model& model_;
  int first_;
  std::vector<int> parent_; // of each triangle; a root is its own
  std::vector<char> open_;  // triangles with an edge that is not between two
  std::map<std::array<double, 3>, int> numbers_;
};

} // namespace

std::vector<int> of_inner_shells(const Model& model) {
  const std::vector<BoundaryTriangle>& all = model.mesh.boundary; // by block
  std::vector<int> inner(all.size(), 0);
  for (auto first = all.begin(); first != all.end();) {
    const auto last = std::find_if(
        first, all.end(), [&](const BoundaryTriangle& triangle) { return triangle.block != first->block; });
    if (!model.blocks[first->block].convex())
      Shells(model, static_cast<int>(first - all.begin()), static_cast<int>(last - all.begin()))
          .mark_inner(inner);
    first = last;
  }
  return inner;
}

} // namespace cdem
