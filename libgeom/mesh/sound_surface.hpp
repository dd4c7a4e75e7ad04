// Surfaces as other programs hand them over, made such that neighbours share whole edges.
#pragma once

#include "libgeom/mesh/surface.hpp"

#include <string>

namespace geom {

inline constexpr double same_corner = 1e-6; // of a surface's size: points nearer than this are one

// Deletes needles, triangles that are at most `tolerance` (m) high; CAD closes gaps with them. Then splits each edge that
// belongs to one triangle only at the corners of others that lie on it within the tolerance (T-junctions). The surface
// moves by no more than the tolerance. Returns how many needles and corners there were.
struct Mended {
  std::size_t needles = 0, corners = 0;
};
Mended mend(Surface&, double tolerance);
std::string
mended_text(const Mended&); // "2 triangles without area, 3 corners on edges of others"; empty: nothing was

// Throws InputError when an edge of a triangle passes through another triangle; `field` names the surface.
void require_uncrossed(const Surface&, const std::string& field, double tolerance);

} // namespace geom
