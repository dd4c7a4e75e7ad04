#include "libcdem/contact/broad_phase/solid_grid.hpp"

#include "libcdem/contact/broad_phase/tets_beyond.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <algorithm>

namespace cdem {
namespace {

using geom::Vec3;

void set_planes(const std::array<Vec3, 4>& x, Solid& solid) {
  for (int k = 0; k < 4; ++k) {
    const Vec3 &a = x[(k + 1) % 4], &b = x[(k + 2) % 4], &c = x[(k + 3) % 4];
    Vec3 normal = (b - a).cross(c - a).normalized();
    if (normal.dot(x[k] - a) > 0)
      normal = -normal;
    solid.normal[k] = normal;
    solid.offset[k] = std::max({normal.dot(a), normal.dot(b), normal.dot(c)});
  }
}

// What stands between the two sides of a face that gives stands within (tets_beyond.hpp).
void take_in_gaps(const Model& model, const State& state, const ContactWork& work, Solid& solid) {
  const int tet = solid.tet - model.mesh.first_tet;
  for (int face = 0; face < 4; ++face) {
    const int beyond = work.tets_beyond[tet][face];
    if (beyond < 0)
      continue;
    for (const int corner : geom::tet_faces[work.neighbours[4 * tet + face] % 4])
      solid.offset[face] = std::max(
          solid.offset[face], solid.normal[face].dot(place_of(model, state, model.tets[beyond][corner])));
  }
}

} // namespace

std::array<Vec3, 4> corners_of_tet(const Model& model, const State& state, int tet) {
  std::array<Vec3, 4> x;
  for (int k = 0; k < 4; ++k)
    x[k] = place_of(model, state, model.tets[tet][k]);
  return x;
}

std::vector<Solid> solids_of(const Model& model, const State& state, const ContactWork& work,
                             const ActiveSurface& active, int block) {
  const ContactSurface& s = model.surface;
  const Block& b = model.blocks[block];
  const std::vector<char> at_surface = tets_at_surface(model, work, block);
  std::vector<int> solid_of(at_surface.size(), -1);
  std::vector<Solid> solids;
  for (int tet = b.tet_begin; tet < b.tet_end; ++tet) {
    if (!at_surface[tet - b.tet_begin])
      continue;
    solid_of[tet - b.tet_begin] = static_cast<int>(solids.size());
    Solid& solid = solids.emplace_back();
    solid.tet = tet;
    solid.mover = work.movers.of_fragment[work.fragment_of_node[model.tets[tet][0]]];
    set_planes(corners_of_tet(model, state, tet), solid);
    take_in_gaps(model, state, work, solid);
  }
  for (int i = active.block_begin[block]; i < active.block_begin[block + 1]; ++i) {
    auto& triangles = solids[solid_of[s.triangles[active.triangles[i]].tet - b.tet_begin]].triangles;
    *std::find(triangles.begin(), triangles.end(), -1) = i;
  }
  return solids;
}

SolidGrid::SolidGrid(const Model& model, const State& state, const std::vector<Solid>& solids,
                     const std::vector<int>& members) {
  std::vector<geom::Box> boxes(members.size());
  double mean = 0; // m
  for (std::size_t i = 0; i < members.size(); ++i) {
    for (const Vec3& corner : corners_of_tet(model, state, solids[members[i]].tet))
      boxes[i].extend(corner);
    all_.extend(boxes[i].min);
    all_.extend(boxes[i].max);
    mean += boxes[i].size().maxCoeff() / static_cast<double>(members.size());
  }
  if (members.empty())
    return;
  constexpr double cells_across = 2; // a tetrahedron
  constexpr double most_cells = 64;  // per tetrahedron
  const auto cells = [&]() -> Eigen::Array3d { return (all_.size() / cell_).array().floor() + 1; };
  cell_ = std::max(mean / cells_across, 1e-9 * all_.size().maxCoeff());
  while (cells().prod() > most_cells * static_cast<double>(members.size() + 1))
    cell_ *= 1.25;
  count_ = cells().cast<int>();
  begin_.assign(static_cast<std::size_t>(count_.prod()) + 1, 0);
  for (const geom::Box& box : boxes)
    each_cell(box.min, box.max, [&](std::size_t c) { ++begin_[c + 1]; });
  for (std::size_t c = 1; c < begin_.size(); ++c)
    begin_[c] += begin_[c - 1];
  entries_.resize(begin_.back());
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    each_cell(boxes[i].min, boxes[i].max, [&](std::size_t c) { entries_[next[c]++] = members[i]; });
}

} // namespace cdem
