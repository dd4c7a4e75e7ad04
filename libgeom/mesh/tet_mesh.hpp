// A mesh of linear tetrahedra, from a solid or a file.
#pragma once

#include "libgeom/polyhedron/polyhedron.hpp"

#include <map>
#include <string>

namespace geom {

// Outer faces that were given a name: indices into outer_faces(mesh), ascending.
using NamedFaces = std::map<std::string, std::vector<int>>;

struct TetMesh {
  std::vector<Vec3> nodes; // m; every node belongs to a tet
  std::vector<Tet> tets;   // over nodes
  std::vector<int> region; // per tet: which of the solid's regions, from 0; neighbouring regions share nodes
  NamedFaces named = {};   // scaling, moving and reordering keep them
};

inline constexpr double max_tets = 2e7; // more would not fit the memory of one machine

// Throws InputError, `source` first, when there are no tets, a coordinate is not finite, a tet is inverted or
// flat or names a node that is not there, or more than two tets share a face.
void validate(const TetMesh&, const std::string& source);

double volume(const TetMesh&); // m3
Box bounding_box(const TetMesh&);
MassProperties mass_properties(const TetMesh&);

} // namespace geom
