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

// tolerance (m): vertices with |phi| <= tolerance count as lying on the plane; 0 means only exact zeros.
// A plane that only touches a vertex, an edge or a face leaves the block whole.
Cut cut(const Polyhedron&, const Plane&, double tolerance = 0);

// Offset of the plane moved so that no vertex lies within `clearance` of it without lying on it to rounding (the
// plane is shifted, never the vertex: a moved vertex would warp its faces). Returns the plane unchanged when clear.
Plane shifted_clear_of_vertices(const Polyhedron&, const Plane&, double clearance);

} // namespace geom
