// Free-form solids: what is not a convex block. A Solid is a value: OpenCASCADE's boundary representation as
// text, shared between copies and never changed. gmsh, which drives OpenCASCADE, stays in the sources behind.
//
// Lengths below min_length or coordinates beyond max_coordinate are refused: OpenCASCADE takes points nearer
// than 1e-7 m for one.
#pragma once

#include "libgeom/assembly/assembly.hpp"

#include <memory>
#include <string>

namespace geom {

class Solid {
public:
  Solid() : Solid("", 0) {} // nothing
  Solid(std::string brep, int regions);

  const std::string& brep() const { return *brep_; }
  int regions() const { return regions_; } // pieces; those of fragments() share their faces

private:
  std::shared_ptr<const std::string> brep_;
  int regions_;
};

inline constexpr double min_length = 1e-4;    // m
inline constexpr double max_coordinate = 1e5; // m

// A closed surface of flat faces. Each face is its outer loop and then the loops of its holes, vertex
// indices; the outer one counter-clockwise seen from outside.
struct FacetedSurface {
  std::vector<Vec3> vertices; // m
  std::vector<std::vector<std::vector<int>>> faces;
};

// Builders. All throw InputError for sizes that are not positive and finite.
Solid make_solid(const FacetedSurface&);
Solid make_solid(const Polyhedron&);
// One region for each block, in their order; regions share the parts of faces that lie on each other.
Solid make_solid(const Assembly&);
Solid box(const Vec3& size, const Vec3& origin);                           // origin: lower corner
Solid cylinder(const Vec3& base, const Vec3& axis, double radius);         // axis: from base to top, m
Solid cone(const Vec3& base, const Vec3& axis, double radius, double top); // truncated unless a radius is 0
Solid sphere(const Vec3& centre, double radius);

// Boolean operations. Throw InputError when nothing is left or OpenCASCADE cannot do it.
Solid united(const std::vector<Solid>&); // coplanar faces that meet become one
Solid cut(const Solid&, const std::vector<Solid>& tools);
Solid common(const Solid&, const Solid&);
// All pieces the solids cut each other into, each point in exactly one; neighbours share the face between
// them, so that their meshes share its nodes.
Solid fragments(const std::vector<Solid>&);

Solid translated(const Solid&, const Vec3& shift);
Solid rotated(const Solid&, const Vec3& axis, double angle, const Vec3& centre); // radians, right-handed
Solid scaled(const Solid&, double factor, const Vec3& centre);

MassProperties mass_properties(const Solid&);     // of all regions together
std::vector<double> region_volumes(const Solid&); // m3
Box bounding_box(const Solid&);                   // to 1e-6 of its size

// STEP file (.step, .stp), units as the file states them. Throws InputError when it is missing, unreadable or
// holds no solid.
Solid read_step(const std::string& path);
void write_step(const Solid&, const std::string& path); // in metres

} // namespace geom
