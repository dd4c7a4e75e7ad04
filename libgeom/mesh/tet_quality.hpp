// How good tetrahedra are for the finite-element and finite-volume elements: sliver elements shrink the
// stable time step and spoil stresses.
#pragma once

#include "libgeom/mesh/tet_mesh.hpp"

namespace geom {

struct TetShape {
  double volume = 0;       // m3
  double radius_ratio = 0; // 3 r_in / r_circumscribed: 1 for a regular tet, 0 for a flat one
  double min_dihedral = 0; // radians; 70.5 degrees for a regular tet
  double max_dihedral = 0;
  double min_height = 0; // m, smallest distance of a corner from its opposite face: what limits the time step
};
TetShape tet_shape(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

struct MeshQuality {
  std::size_t nodes = 0, tets = 0, outer_faces = 0;
  double volume = 0, min_volume = 0, max_volume = 0; // m3
  double min_radius_ratio = 0, mean_radius_ratio = 0;
  double min_dihedral = 0, max_dihedral = 0;        // radians
  double min_height = 0;                            // m
  double min_edge = 0, mean_edge = 0, max_edge = 0; // m
};
MeshQuality quality(const TetMesh&);

} // namespace geom
