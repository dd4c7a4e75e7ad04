// Cutting a convex block by a plane with level sets: faces, then edges (Han 2010 eqs 18-20).
#pragma once

#include "libgeom/polyhedron/polyhedron.hpp"

#include <optional>

namespace geom {

inline constexpr int cut_face = -1; // parent of the face that the cut itself made

struct Part {
  Polyhedron shape;
  std::vector<int> parent_face; // for each face of shape: the face of the parent it is (part of), or cut_face
};

struct Cut {
  std::optional<Part> above; // phi > 0; empty when the whole block lies below
  std::optional<Part> below; // phi < 0
};

// tolerance (m): vertices with |phi| <= tolerance count as lying on the plane; vertices that lie on it to
// rounding always do. A plane that only touches a vertex, an edge or a face leaves the block whole. Blocks
// that share an edge get the same point on it to the last bit. Throws InputError when the block is so far
// from convex that the plane leaves more than one loop on it.
Cut cut(const Polyhedron&, const Plane&, double tolerance = 0);

// Offset of the plane moved so that no vertex lies within `clearance` of it without lying on it to rounding
// (the plane is shifted, never the vertex: a moved vertex would warp its faces). Returns the plane unchanged
// when clear.
Plane shifted_clear_of_vertices(const Polyhedron&, const Plane&, double clearance);

// The smallest shift (m) of a plane with vertices at these levels such that each level is at least
// `clearance` away from it or on it to `rounding`.
double clear_shift(std::vector<double> levels, double clearance, double rounding);

} // namespace geom
