// A mesh of linear tetrahedra, from a solid or a file, and its outer faces.
#pragma once

#include "libgeom/core/types.hpp"

#include <string>
#include <vector>

namespace geom {

struct TetMesh {
  std::vector<Vec3> nodes; // m; every node belongs to a tet
  std::vector<Tet> tets;   // over nodes
  std::vector<int> region; // per tet: which of the solid's regions, from 0; neighbouring regions share nodes
};

// A face that only one tet has. Sorted by tet, then face: the order does not depend on how the mesh was made.
struct OuterFace {
  Triangle nodes; // counter-clockwise seen from outside
  int tet = 0;
};

// Throws InputError, `source` first, when there are no tets, a coordinate is not finite, a tet is inverted or
// flat or names a node that is not there, or more than two tets share a face.
void validate(const TetMesh&, const std::string& source);

double volume(const TetMesh&); // m3
Box bounding_box(const TetMesh&);
std::vector<OuterFace> outer_faces(const TetMesh&);

// Which outer faces. Indices into `faces`, ascending; empty when there are none.
std::vector<int> faces_on_plane(const TetMesh&, const std::vector<OuterFace>& faces, const Plane&,
                                double tolerance); // m, all three nodes
// "x-" ... "z+": faces in that face of the bounding box, to 1e-6 of its size. Throws InputError for another
// name.
std::vector<int> faces_on_side(const TetMesh&, const std::vector<OuterFace>& faces, const std::string& side);
// Faces whose outward normal is within `angle` (radians) of a direction.
std::vector<int> faces_towards(const TetMesh&, const std::vector<OuterFace>& faces, const Vec3& direction,
                               double angle);

struct FaceGroup {
  double area = 0;                 // m2
  Vec3 centroid = Vec3::Zero();    // m
  Vec3 area_vector = Vec3::Zero(); // sum of outward normals times area, m2
};
FaceGroup measure(const TetMesh&, const std::vector<OuterFace>& faces, const std::vector<int>& chosen);

} // namespace geom
