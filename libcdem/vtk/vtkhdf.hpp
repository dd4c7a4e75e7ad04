// VTKHDF files of unstructured grids: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html#vtkhdf-file-format,
// version 1.0, one part. VTK 9.1 reads the format and does not write it; this is the only place that sees libhdf5.
#pragma once

#include <string>

class vtkUnstructuredGrid;

namespace cdem {

// Points, connectivity, types, arrays of points, cells and field data, gzip. Every array has its unit as attribute
// "unit", where it is known; an array of field data with names of components is written as these names, a list of texts.
// False where the file could not be written whole.
bool write_vtkhdf(vtkUnstructuredGrid*, const std::string& path);

// By VTK's reader in a child process, since a forged file can crash libhdf5: the bytes of a .vtu without compression; none
// where it cannot be read. Throws geom::InputError where the child crashes or needs too much.
std::string vtkhdf_as_vtu(const std::string& path);

} // namespace cdem
