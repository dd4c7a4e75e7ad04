// Surfaces of triangles from files: STL (binary or text) and DXF (text: 3DFACE, polyface meshes, polygon meshes).
#pragma once

#include "libgeom/mesh/surface.hpp"

#include <string>

namespace geom {

// Three corners for each triangle, in a row, as the file gives them.
struct FileTriangles {
  std::vector<Vec3> corners;
  std::string note; // what the user should know: entities that are no faces, a unit; empty: nothing
};
FileTriangles stl_triangles(const std::string& bytes, const std::string& path);
FileTriangles dxf_triangles(const std::string& bytes, const std::string& path);

struct FileSurface {
  Surface surface; // corners nearer than 1e-6 of its size are one; no triangle has shrunk to an edge
  std::string note;
};

// By the ending, .stl or .dxf; coordinates are multiplied by `scale`. The surface may be open. Throws InputError when the
// file is missing or not of its format, a coordinate is not finite, no triangle is left, there are more than `most`, or
// more than two meet in an edge.
FileSurface read_surface(const std::string& path, double scale, std::size_t most);

inline constexpr std::size_t max_surface_triangles = 1000000;

} // namespace geom
