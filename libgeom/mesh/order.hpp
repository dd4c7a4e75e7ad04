// An order of tets and nodes in which neighbours in space are neighbours in memory: tets along a Hilbert curve
// through their centroids, nodes in the order in which these tets use them.
#pragma once

#include "libgeom/core/hilbert.hpp"
#include "libgeom/mesh/tet_mesh.hpp"

namespace geom {

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
