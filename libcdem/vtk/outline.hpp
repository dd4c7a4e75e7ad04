// What is drawn of a mesh besides its faces: the outside and the edges of blocks, and the outline of broken
// interfaces.
#pragma once

#include "libcdem/results/snapshot.hpp"

namespace cdem {

// Fills surface, surface_tet and block_edges from the tets and the cell field "block_id" (without it: one
// block). A face belongs to the surface when only one tet of its block has it, an edge to the outline when
// the surface has a corner of more than `crease` there (radians; below 0: every edge). Nodes of a block at the
// same place count as one.
inline constexpr double flat_crease = 0.1 * 3.14159265358979323846 / 180;
void find_surface(Snapshot&, double crease = flat_crease);

struct BrokenInterfaces {
  std::vector<geom::Vec3> points; // m, moved by the scaled displacement
  struct Part {
    std::vector<geom::Triangle> triangles;
    std::vector<std::array<int, 2>> outline; // edges that only one broken triangle of an interface has
  };
  Part tension, shear;
};
BrokenInterfaces broken_interfaces(const BondSnapshot&, double deformation);

// points + scale * displacement; the points themselves when there is no displacement or the scale is 0.
std::vector<geom::Vec3> deformed(const std::vector<geom::Vec3>& points, const SnapshotField* displacement,
                                 double scale);

} // namespace cdem
