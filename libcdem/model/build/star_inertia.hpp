// The moments of inertia of a star block that moves far.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// Scales the masses of all nodes of a star block but its centroid by
//   s = integral r^2 dm / sum m_i r_i^2,   r from the centroid,
// and gives the rest to the centroid's node. So the block turns as the solid does: its mass, its centre of mass and the
// trace of its moments of inertia are the solid's (each moment, if it is a box). With a quarter of each tetrahedron at each
// of its nodes a cube would have 1.75 times the solid's. Weights keep these quarters: they alone balance a stress that
// rises with depth.
void match_star_inertia(Model&, int block);

} // namespace cdem
