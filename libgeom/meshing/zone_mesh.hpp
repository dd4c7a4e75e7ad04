// Zones of a convex block: a mesh of tetrahedra of one size inside it, by gmsh's Delaunay. The same block and size give
// the same mesh. Neighbouring blocks are meshed by themselves, so that the triangles on their common face need not match.
#pragma once

#include "libgeom/mesh/block_mesh.hpp"
#include "libgeom/polyhedron/polyhedron.hpp"

namespace geom {

inline constexpr int max_zone_nodes = 65535; // of one block: places in a chunk are numbered by 16 bits

// size: edge length, m. A block that has fewer zones than tets in its star mesh, or that gmsh cannot fill, gets its star
// mesh. Throws InputError about `zone_size` when it is not positive, or asks a block for too many tets.
std::vector<BlockMesh> zone_meshes(const std::vector<Polyhedron>&, double size);

} // namespace geom
