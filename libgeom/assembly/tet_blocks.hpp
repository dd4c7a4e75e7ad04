// Tetrahedra of a mesh as the blocks of an assembly: tets that share a face share it as blocks.
#pragma once

#include "libgeom/assembly/assembly.hpp"
#include "libgeom/mesh/tet_mesh.hpp"

namespace geom {

Assembly tet_blocks(const TetMesh&);

} // namespace geom
