// Normals of the smooth surface that the triangles of a mesh stand for, at the corners of each triangle. Triangles between
// points of a cylinder are not quite parallel to its axis: by their own normals a stream along it would push on its side.
// Triangles that share an edge belong to one smooth surface where they turn by less than 40 degrees.
//
// The normal of a corner is that of the paraboloid through it that fits the points of the surface near it best, two edges
// away at most, so it is exact for planes and nearly so for cylinders and spheres.
#pragma once

#include "libcdem/model/model.hpp"

#include <array>

namespace cdem {

// Of one outer triangle, unit, undeformed: along its first edge, across it in its plane, along its own outward normal.
using CornerNormals = std::array<geom::Vec3, 3>;

// For each of the given outer faces; for those of convex blocks, which are flat, along the face's own normal.
std::vector<CornerNormals> smooth_normals(const Model&, const std::vector<int>& faces);

// The same as the corners x stand now.
CornerNormals turned_with(const CornerNormals&, const std::array<geom::Vec3, 3>& x);

} // namespace cdem
