// Faces of blocks, divided so that neighbours have the same ones: the common part of two faces is one part of both blocks,
// and what no other block covers is divided into convex parts. Every corner that lies on an edge is a point of it. So
// meshes of the blocks that keep the parts are one mesh together, whether or not the blocks' faces match.
#pragma once

#include "libgeom/assembly/assembly.hpp"

namespace geom {

struct FacePart {
  std::vector<int> loop; // points, convex, counter-clockwise seen from outside block_a
  int block_a = 0, face_a = 0;
  int block_b = -1, face_b = -1; // on the other side; -1: nothing
};

struct DividedFaces {
  std::vector<Vec3> points; // m
  std::vector<FacePart> parts;
};

Vec3 centroid(const DividedFaces&, const FacePart&); // of its area, m

// Points nearer than the tolerance (m) are one. Throws InputError where the parts of a block do not enclose it.
DividedFaces divided_faces(const std::vector<Polyhedron>& blocks, double tolerance);

} // namespace geom
