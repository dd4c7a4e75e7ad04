// Meshes in VTK's files from other programs: legacy .vtk and .vtu, text or binary.
#pragma once

#include "libgeom/mesh/read_mesh.hpp"

namespace cdem {

// The linear tetrahedra of the file, read in a child process under limits. Regions by cell data with whole numbers
// (geom::label_regions). Throws geom::InputError as geom::read_mesh_file does.
geom::MeshFile read_vtk_mesh(const std::string& path, const std::string& regions);

// Whether the file ends with the checksum that write_vtu writes.
bool is_vtu_of_ours(const std::string& path);

} // namespace cdem
