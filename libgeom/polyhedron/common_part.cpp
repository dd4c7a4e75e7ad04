#include "libgeom/polyhedron/common_part.hpp"

#include "libgeom/polyhedron/cut.hpp"

#include <algorithm>

namespace geom {

std::vector<Plane> face_planes(const Polyhedron& shape) {
  std::vector<Plane> planes;
  planes.reserve(shape.faces.size());
  for (int f = 0; f < static_cast<int>(shape.faces.size()); ++f)
    planes.push_back(Plane::through(shape.vertices[shape.faces[f].loop.front()], face_normal(shape, f)));
  return planes;
}

bool apart(const std::vector<Plane>& planes, const Polyhedron& other, double depth) {
  return std::any_of(planes.begin(), planes.end(), [&](const Plane& plane) {
    return std::all_of(other.vertices.begin(), other.vertices.end(),
                       [&](const Vec3& x) { return plane.level(x) >= -depth; });
  });
}

std::optional<Polyhedron> common_part(const Polyhedron& block, const std::vector<Plane>& planes,
                                      double tolerance) {
  Polyhedron rest = block;
  for (const Plane& plane : planes) {
    Cut parts = cut(rest, plane, tolerance);
    if (!parts.below)
      return {};
    rest = std::move(parts.below->shape);
  }
  return rest;
}

} // namespace geom
