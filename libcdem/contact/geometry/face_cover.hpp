// Which area each contact of two flat faces that lie on each other stands for.
//
// Semi-springs stand at the corners of triangles, and semi-edges where outlines cross. Each has a part of its triangles' area,
// whatever part of these the other face covers. So two faces would press with more or less than the pressure times the
// area in which they cover each other: a block that reaches over the next one by a hundredth would rest on it with a quarter of
// its weight. The two faces F and G cover each other in the polygon P. The contacts c that they can have stand in its corners, and
// within it, at x_c, with the areas A_c of the paper (half of each for either body). Weights that are linear in the plane,
//
//   sum of A_c w(x_c) = 2 |P|,   sum of A_c w(x_c) x_c = 2 |P| (centroid of P)
//
// give both faces together the pressure times the area of P, at its centroid. Where the faces cover each other wholly and have
// equal triangles, w is 1. Every w lies within a tenth and 1.9 of that at the mean place of the contacts.
//
// A contact that came or went with its full weight would change what the faces store under a moment. So where the faces have
// edges of single triangles, each corner of P gives half of the two triangles between it and the centroid to the contacts near
// it, which is exact for a linear depth, and A_c counts fully only well within P. Semi-springs count less near the
// outline of the other face, and crossings near an end of their edges.
#pragma once

#include "libcdem/contact/data/flat_faces.hpp"
#include "libcdem/contact/geometry/positions.hpp"
#include "libcdem/state/state.hpp"
#include "libgeom/query/clip_polygon.hpp"
#include "libgeom/query/flat_fan.hpp"

namespace cdem {

FlatFaces flat_faces(const Model&);

// m2: A of a semi-spring, and of two edges; each from the areas of the triangles at both.
inline double spring_area(double from, double to) {
  return 2 * from * to / (from + to) / 3;
}
inline double edge_area(double e, double f) {
  return (e + f) / 3;
}

struct FaceCover {
  bool flat = false; // the two lie on each other
  geom::PlaneAxes axes{};
  geom::Polygon covered;                                // P
  std::vector<std::pair<double, geom::Point>> contacts; // that the two can have: A_c, and where
  // What follows is known once it is weighed.
  bool weighed = false;
  geom::Polygon corners;      // of P, at which contacts can stand
  std::vector<double> share;  // per corner: its area over the sum of A_c k(x_c) there; empty: all have A_c
  double within = 0;          // part of A_c of contacts well within P
  double size = 0, reach = 0; // m, of P, and of k
  double part(const geom::Point& place) const;  // of A_c
  double usual = 1;                             // w at the mean place of the contacts
  geom::Point mean = geom::Point::Zero();       // m, this place
  geom::Point slope = geom::Point::Zero();      // 1/m
  double weight(const geom::Vec3& place) const; // w
  bool covers(const geom::Vec3& place) const;
  double part_of_spring(const geom::Vec3& place, const FlatFace& own) const; // that counts
};

// Part of a crossing that counts, by how far it is from an end of one of its edges, in parts of the edge.
inline double part_at_end(double from_end) {
  return std::clamp(from_end / drawn_in - 1, 0.0, 1.0);
}

// Whether faces with these normals can do so: within 2.9 degrees.
bool lie_on_each_other(const geom::Vec3& normal, const geom::Vec3& other);
FaceCover cover_of(const Model&, const State&, const FlatFace&, const FlatFace&);
void weigh(FaceCover&, const FlatFace&, const FlatFace&);

} // namespace cdem
