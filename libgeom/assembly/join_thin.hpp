// Merges splinters that joint sets leave, blocks thinner than a given length, with a neighbour.
//
// The thickness of a block is its least height over one of its faces. A thin block is merged with a neighbour if they
// share a whole face and are convex together. The largest such face is taken. If there is none, the block's largest
// face to a neighbour is glued: the block stays, and the joint there is removed. Faces that a construction cut glued count
// for neither: a splinter at the outline of an excavation joins a neighbour on its own side.
#pragma once

#include "libgeom/assembly/assembly.hpp"

#include <optional>

namespace geom {

double thickness(const Polyhedron&); // m, least height over a face

// Two blocks that have a whole face in common as one; none when they are not convex together. Faces that come to lie in one plane
// become one, with the name that face has in `a`.
std::optional<Polyhedron> united(const Polyhedron& a, int face_a, const Polyhedron& b, int face_b);

struct JoinedThin {
  Assembly assembly;
  std::int64_t united = 0, glued = 0; // thin blocks
};
JoinedThin join_thin(Assembly, double smallest); // m; throws InputError unless it is >= 0

} // namespace geom
