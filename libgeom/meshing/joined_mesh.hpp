// Blocks that are whole together as one mesh: each block is a region, and neighbours share the nodes of their common parts.
#pragma once

#include "libgeom/assembly/divided_faces.hpp"
#include "libgeom/mesh/tet_mesh.hpp"

namespace geom {

// Every tet = volume centroid of a block + area centroid of a part + the two ends of an edge of the part: the star mesh
// of Han 2010 (mesh/star_mesh.hpp) where faces match. Region i: block i.
TetMesh joined_mesh(const std::vector<Polyhedron>&, const DividedFaces&);

// The same filled by gmsh with tets of this edge length, m. Throws InputError about `zone_size`.
TetMesh joined_mesh(const std::vector<Polyhedron>&, const DividedFaces&, double zone_size);

} // namespace geom
