// Meshes from other programs.
#pragma once

#include "libgeom/mesh/tet_mesh.hpp"

namespace geom {

// Linear tetrahedra of a gmsh (.msh), Medit (.mesh), Nastran (.bdf), I-deas (.unv) or legacy VTK (.vtk) file,
// coordinates in metres; regions are the file's volumes in ascending order. Validated. Throws InputError when
// the file is missing, unreadable, of another format, or holds other volume elements or none.
TetMesh read_mesh(const std::string& path);

} // namespace geom
