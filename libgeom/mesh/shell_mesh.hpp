// An open surface of triangles as a wall: a mesh of tetrahedra that has the surface as one of its sides. Contact needs bodies
// with a volume; a drum, a funnel, a chute or a terrain from an STL file has none.
//
// Each point x of the surface gets a point x + d behind it. d is the least displacement that moves the planes of the
// triangles around the point by the thickness, in the mean:
//
//   d = -thickness * (sum w n n^T)^+ (sum w n)
//
// with n the normals towards the front, w the angles at the point, ^+ the pseudo-inverse. Each triangle and its copy are a
// prism of three tetrahedra. Diagonals run from the point with the smaller number, so neighbours share triangles.
#pragma once

#include "libgeom/mesh/surface.hpp"
#include "libgeom/mesh/tet_mesh.hpp"

#include <optional>

namespace geom {

// thickness: m, > 0. front: m, a place on the side where bodies touch the wall; each connected part of the surface is turned
// to it. Without it the front is where the normals of the triangles point (counter-clockwise seen from there). Throws
// InputError where the surface has but one side, three triangles meet in an edge, or the thickness does not fit its bends.
TetMesh shell_mesh(const Surface&, double thickness, const std::optional<Vec3>& front);

} // namespace geom
