// One convex block: vertices and faces with one closed loop each (Han 2010 section 1.1).
#pragma once

#include "libgeom/core/types.hpp"

#include <string>

namespace geom {

struct PolyhedronFace {
  std::vector<int> loop; // vertex indices, counter-clockwise seen from outside
  std::string cut = {}; // name of the joint set or cut that made the face; empty: none, or one without a name
  bool glued = false;   // made by a construction cut: no joint
};

struct Polyhedron {
  std::vector<Vec3> vertices; // m
  std::vector<PolyhedronFace> faces;
};

// Unique edges as vertex pairs (smaller index first), sorted.
std::vector<std::array<int, 2>> edges(const Polyhedron&);

Vec3 face_normal(const Polyhedron&, int face);   // unit, outward
double face_area(const Polyhedron&, int face);   // m2
Vec3 face_centroid(const Polyhedron&, int face); // area centroid, m
Box bounding_box(const Polyhedron&);

// Throws InputError when the polyhedron is not closed, not convex, has a warped face (relative tolerance 1e-9
// of its size), inward faces, a zero volume, non-finite coordinates, or fails Euler's V - E + F = 2.
void validate(const Polyhedron&);

// Axis-aligned box; min and max are opposite corners.
Polyhedron make_box(const Vec3& min, const Vec3& max);

struct MassProperties {
  double volume = 0;            // m3
  Vec3 centroid = Vec3::Zero(); // m
  Mat3 inertia = Mat3::Zero();  // about the own centroid for unit density, m5
};

// Computed from tets about the block's own first vertex, never about the global origin, so that a block far
// away keeps its digits.
MassProperties mass_properties(const Polyhedron&);

double principal_inertia_ratio(const MassProperties&); // largest over smallest principal moment

} // namespace geom
