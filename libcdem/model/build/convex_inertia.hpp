// The moments of inertia of a convex block that moves far.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// With a quarter of each tetrahedron at each of its nodes a cube that is one block would have 1.75 times its solid's
// moments. So the masses at the nodes are changed in two steps, after which mass m, centroid c and second moments
// S = integral r r^T dm, r from the centroid, are those of the solid:
//
//   1. masses on the surface times s, those inside times t, such that m and the trace of S are the solid's
//   2. times q(r) = 1 + a quadratic polynomial of r, the least change (of sum (m_i - m_i0)^2 / m_i0) after which all ten
//      sums are the solid's; where q is below 0.7 it is 0.7, and the others make up for it
//
// The stable step goes with the square root of a node's mass, hence the bound. Where too few nodes are left above it, all go
// towards that q until the first comes to 0.7: so it is with zones that have no node inside. A box needs no step 2. Weights
// keep the quarters: they alone balance a stress that rises with depth. Corners of a star block that are too light have
// been raised before (build/light_corners).
void match_convex_inertia(Model&, int block);

} // namespace cdem
