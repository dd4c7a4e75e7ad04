// Bonded blocks that are continuous until they crack (bonds = "cohesive"): the blocks of a body become one mesh, in which
// each is a region, and their joints stand on the borders of the regions. So blocks and meshes have one bond
// (bond/cohesive_faces.hpp).
//
// Springs at the corners of faces share out the forces where three or more blocks meet in an edge, and nothing says how:
// under an all-round stress p they carry 0.9 to 1.7 p, however stiff they are. Nodes that blocks share carry p.
#pragma once

#include "libcdem/simulation.hpp"

namespace cdem {

// Of a body whose bonding is cohesive. Throws geom::InputError for joints that are no bonds.
void join_blocks(BodySpec&);

} // namespace cdem
