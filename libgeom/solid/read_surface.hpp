// Surfaces of triangles from files: STL (binary or text), DXF (text: 3DFACE, polyface meshes, polygon meshes), OBJ, OFF, PLY
// and GOCAD (.ts).
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
FileTriangles polygon_triangles(const std::string& path); // OBJ, OFF, PLY, GOCAD

struct FileSurface {
  Surface surface; // mended (sound_surface.hpp): corners nearer than 1e-6 of its size are one
  std::string note;
  std::string mended; // what was mended; empty: nothing
};

// By the ending; coordinates are multiplied by `scale` and then moved by `shift` (m): far from the origin little is left
// of their digits. The surface may be open. Throws InputError when the
// file is missing or not of its format, a coordinate is not finite, no triangle is left, there are more than `most`, more
// than two meet in an edge, or the surface crosses itself.
FileSurface read_surface(const std::string& path, double scale, std::size_t most,
                         const Vec3& shift = Vec3::Zero());

inline constexpr std::size_t max_surface_triangles = 1000000;

} // namespace geom
