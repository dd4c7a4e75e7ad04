// A box cut into cells of six tetrahedra each (Kuhn's subdivision, all about the diagonal from the lower to
// the upper corner), so that neighbouring cells share the triangles between them. For tests and benchmarks.
#pragma once

#include "libgeom/mesh/tet_mesh.hpp"

namespace geom {

// Largest jitter. A tet whose corners move by less than j cells along every axis cannot turn over unless a
// plane meets the cubes of half width j about all four corners; in Kuhn's tets the narrowest normal to one is
// (1, -1, 1), across which a tet is 1 wide and the cubes 6 j: j < 1/6.
inline constexpr double max_box_jitter = 0.16;

// `size` in m, lower corner at the origin. 6 nx ny nz tets, cell by cell, x fastest; node (i, j, k) is
// i + (nx + 1) (j + (ny + 1) k). With jitter every inner node is moved along each axis by a random share of
// the cell's edge, from -jitter to jitter, keyed by the seed and the node. Throws InputError for sizes that
// are not positive, divisions below 1, more than max_tets tets, or jitter beyond max_box_jitter.
TetMesh box_mesh(const Vec3& size, const std::array<int, 3>& divisions, double jitter = 0,
                 std::uint64_t seed = 1);

} // namespace geom
