// The tetrahedra of a block that has broken, in cells of a uniform grid.
#pragma once

#include "libcdem/contact/broad_phase/active_surface.hpp"

namespace cdem {

// A tetrahedron of the block with a node on its surface.
struct Solid {
  std::array<geom::Vec3, 4> normal; // unit, outwards
  std::array<double, 4> offset{};   // m, of the planes
  int tet = 0, mover = 0;
  std::array<int, 4> triangles{-1, -1, -1,
                               -1}; // that bound it and are active, by their places in ActiveSurface

  // m: a place is at least that far outside; below 0 it is inside.
  double outside(const geom::Vec3& x) const {
    return std::max(std::max(normal[0].dot(x) - offset[0], normal[1].dot(x) - offset[1]),
                    std::max(normal[2].dot(x) - offset[2], normal[3].dot(x) - offset[3]));
  }
};

// By tetrahedron. What lies deeper no contact reaches.
std::vector<Solid> solids_of(const Model&, const State&, const ContactWork&, const ActiveSurface&, int block);

std::array<geom::Vec3, 4> corners_of_tet(const Model&, const State&, int tet); // m

// Some of the tetrahedra in cells of a uniform grid.
class SolidGrid {
public:
  // members: of the solids
  SolidGrid(const Model&, const State&, const std::vector<Solid>& solids, const std::vector<int>& members);

  // take(solid) for all that may come as near as `reach` to x, some more than once.
  template <class Take>
  void each_near(const geom::Vec3& x, double reach, const Take& take) const {
    const geom::Vec3 around = geom::Vec3::Constant(reach);
    if (entries_.empty() || ((x + around).array() < all_.min.array()).any() ||
        ((x - around).array() > all_.max.array()).any())
      return;
    each_cell(x - around, x + around, [&](std::size_t c) {
      for (int i = begin_[c]; i < begin_[c + 1]; ++i)
        take(entries_[i]);
    });
  }

private:
  template <class Visit>
  void each_cell(const geom::Vec3& low, const geom::Vec3& high, const Visit& visit) const {
    Eigen::Vector3i from, to;
    for (int axis = 0; axis < 3; ++axis) {
      from[axis] = std::clamp(static_cast<int>((low[axis] - all_.min[axis]) / cell_), 0, count_[axis] - 1);
      to[axis] = std::clamp(static_cast<int>((high[axis] - all_.min[axis]) / cell_), 0, count_[axis] - 1);
    }
    for (int z = from.z(); z <= to.z(); ++z)
      for (int y = from.y(); y <= to.y(); ++y)
        for (int x = from.x(); x <= to.x(); ++x)
          visit((static_cast<std::size_t>(z) * count_.y() + y) * count_.x() + x);
  }

  geom::Box all_;
  double cell_ = 1; // m
  Eigen::Vector3i count_ = Eigen::Vector3i::Ones();
  std::vector<int> begin_, entries_; // per cell
};

} // namespace cdem
