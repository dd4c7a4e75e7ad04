// An order of tets and nodes in which neighbours in space are neighbours in memory: tets along a Hilbert curve
// through their centroids (Skilling 2004, "Programming the Hilbert curve"), nodes as these tets touch them.
#pragma once

#include "libgeom/mesh/tet_mesh.hpp"

namespace geom {

// Distance along the curve through a grid of 2^21 cells in each axis.
std::uint64_t hilbert_index(std::array<std::uint32_t, 3> cell);

struct MeshOrder {
  std::vector<int> tets;  // old number by new place
  std::vector<int> nodes; // old number by new place; those of no tet come last
};

// The same for the same mesh, whatever the machine; tets in one cell keep their order.
MeshOrder hilbert_order(const TetMesh&);

std::vector<int> inverse(const std::vector<int>& permutation);
TetMesh reordered(const TetMesh&, const MeshOrder&); // corners of a tet keep their order
TetMesh ordered(const TetMesh&);                     // by hilbert_order

} // namespace geom
