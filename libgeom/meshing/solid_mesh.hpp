// Tetrahedra of a solid: Delaunay, then optimised, by gmsh. The same solid and sizes give the same mesh.
#pragma once

#include "libgeom/mesh/mesh_size.hpp"
#include "libgeom/mesh/tet_mesh.hpp"
#include "libgeom/solid/solid.hpp"

namespace geom {

// Throws InputError when the sizes ask for more than max_tets, and when gmsh cannot mesh the solid or leaves
// a part of it empty; the process can mesh on after that.
TetMesh mesh_solid(const Solid&, const MeshSize&);

} // namespace geom
