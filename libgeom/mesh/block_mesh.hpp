// Tetrahedra that fill a convex block, and which of their triangles tile each of its faces.
#pragma once

#include "libgeom/core/types.hpp"

#include <vector>

namespace geom {

struct BlockMesh {
  std::vector<Vec3> nodes; // m; the block's vertices come first, in their order
  std::vector<Tet> tets;
  std::vector<std::vector<Triangle>> fans; // per face of the block: its triangles, seen from outside
  std::vector<std::vector<int>> fan_tets;  // the tet that each of these triangles bounds
};

} // namespace geom
