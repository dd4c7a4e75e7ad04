// A surface of triangles on its own: the outside of a mesh, wherever its nodes stand now.
#pragma once

#include "libgeom/mesh/tet_mesh.hpp"

namespace geom {

struct Surface {
  std::vector<Vec3> points; // m
  std::vector<Triangle> triangles;

  std::array<Vec3, 3> corners(std::size_t triangle) const {
    const Triangle& t = triangles[triangle];
    return {points[t[0]], points[t[1]], points[t[2]]};
  }
};

// The outer faces of a mesh over the nodes they have, in the order of outer_faces.
Surface surface_of(const TetMesh&);
Box bounding_box(const Surface&);

// Throws InputError when more than two triangles meet in an edge; `field` names the surface.
void require_single(const Surface&, const std::string& field);

// Edges that belong to one triangle only, from the corner with the smaller number; none: the surface is closed.
std::vector<std::array<int, 2>> open_edges(const Surface&);

} // namespace geom
