// The outside of a solid as triangles.
#pragma once

#include "libgeom/mesh/surface.hpp"
#include "libgeom/solid/solid.hpp"

namespace geom {

// Flat faces exactly, over the solid's own corners; curved ones by chords that leave them by at most `tolerance` (m), between
// points on them. Throws InputError when a face is curved and the tolerance is 0.
Surface facets(const Solid&, double tolerance);
bool has_curved_faces(const Solid&);

} // namespace geom
