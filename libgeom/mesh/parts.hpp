// Parts of a mesh: sets of tets that are connected, directly or through others, by shared nodes.
#pragma once

#include "libgeom/mesh/tet_mesh.hpp"

namespace geom {

std::vector<int> part_of_tets(const TetMesh&); // per tet, from 0, by the first tet of each part
int count_parts(const TetMesh&);

// Each part as a mesh of its own: tets and nodes keep their order, regions and named faces are kept.
std::vector<TetMesh> parts(const TetMesh&);

} // namespace geom
