// Star mesh of a convex block: every tet = volume centroid + a face's area centroid + the two ends of an edge
// of that face (Han 2010 fig 2).
#pragma once

#include "libgeom/mesh/block_mesh.hpp"
#include "libgeom/polyhedron/polyhedron.hpp"

namespace geom {

// Nodes: the block's vertices, then one centre per face, then the centroid. Triangles: face centre, edge start, edge
// end. Tets: the centroid, then such a triangle, in the order of the fans.
BlockMesh star_mesh(const Polyhedron&);

} // namespace geom
