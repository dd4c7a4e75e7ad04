// Closed surfaces from files of triangles: STL, OBJ, OFF, PLY, DXF, GOCAD.
#pragma once

#include "libgeom/solid/solid.hpp"

namespace geom {

// The surface with coincident corners merged (within 1e-6 of its size) and its triangles outward; coordinates
// are multiplied by `scale`, since STL has no unit. Throws InputError when the file is missing or no STL, has
// a coordinate that is not finite, or is not one closed surface. `mended` receives what read_surface mended.
FacetedSurface read_stl(const std::string& path, double scale = 1, const Vec3& shift = Vec3::Zero(),
                        std::string* mended = nullptr);

inline constexpr std::size_t max_stl_triangles = 50000; // as faces of a solid; more take OpenCASCADE minutes

} // namespace geom
