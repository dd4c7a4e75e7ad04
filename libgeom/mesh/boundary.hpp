// Faces of a tet mesh: the tets at each face, the outer faces, and the edges of the outside. The time is proportional
// to the number of tets, and the order of every list depends only on the mesh's numbering.
#pragma once

#include "libgeom/mesh/tet_mesh.hpp"

namespace geom {

// Corners of a tet's faces, counter-clockwise seen from outside; face i is opposite to corner i.
inline constexpr std::array<std::array<int, 3>, 4> tet_faces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

// For face f of tet t, at 4 t + f: the same number of that face in the tet on its other side, or -1 outside.
// Throws InputError when more than two tets share a face. Nodes must be from 0 to node_count - 1.
std::vector<int> face_neighbours(const std::vector<Tet>&, std::size_t node_count);

// A face that only one tet has.
struct OuterFace {
  Triangle nodes; // counter-clockwise seen from outside
  int tet = 0;
  int face = 0; // of the tet: nodes are its corners tet_faces[face]
};
std::vector<OuterFace> outer_faces(const TetMesh&); // by tet, then face
std::vector<OuterFace> outer_faces(const TetMesh&,
                                   const std::vector<int>& neighbours); // those of face_neighbours

// A face between two tets, the lower one first.
struct InnerFace {
  std::array<int, 2> tets{};
  std::array<int, 2> faces{};
  Triangle nodes{}; // counter-clockwise seen from outside the first tet
  // Where these nodes are among the corners of each tet: mesh.tets[tets[s]][corners[s][i]] == nodes[i].
  std::array<std::array<int, 3>, 2> corners{};
};
std::vector<InnerFace> inner_faces(const TetMesh&); // by first tet, then its face
std::vector<InnerFace> inner_faces(const TetMesh&,
                                   const std::vector<int>& neighbours); // those of face_neighbours

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
