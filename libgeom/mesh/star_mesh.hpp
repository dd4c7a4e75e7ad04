// Star mesh of a convex block: every tet = volume centroid + a face's area centroid + the two ends of an edge
// of that face (Han 2010 fig 2).
#pragma once

#include "libgeom/polyhedron/polyhedron.hpp"

namespace geom {

struct StarMesh {
  std::vector<Vec3> nodes; // the block's vertices (same order), then one centre per face, then the centroid
  std::vector<Tet> tets;
  std::vector<std::vector<Triangle>> fans; // per face: triangles (face centre, edge start, edge end), outward
};

StarMesh star_mesh(const Polyhedron&);

} // namespace geom
