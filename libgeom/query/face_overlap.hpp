// Overlap of two coplanar faces that look at each other, each a fan of triangles: the points that carry the
// springs between them. A third of each overlap triangle's area stands at its corners; coincident points are
// merged; each point is interpolated linearly in the triangle it lies in, on both sides. On matching faces
// these are exactly the corner and face-centre springs of Han 2010 section 1.2; on others it replaces eqs
// 21-22, which fail the patch test.
#pragma once

#include "libgeom/core/types.hpp"

namespace geom {

struct OverlapPoint {
  Vec3 position;                     // m
  double area = 0;                   // m2
  std::array<int, 3> nodes_a{};      // nodes of a's triangle; unused places repeat the first with weight 0
  std::array<double, 3> weights_a{}; // barycentric, sum 1; exact 0 and 1 when the point sits on a node
  std::array<int, 3> nodes_b{};
  std::array<double, 3> weights_b{};
};

struct FaceOverlap {
  std::vector<OverlapPoint> points;
  std::vector<Triangle> triangles; // indices into points; together they tile the overlap
  double area = 0;                 // m2
};

// nodes_x: node positions; fan_x: triangles over them. normal: unit, out of a. tolerance (m): points nearer
// than this are one; overlaps of less than tolerance^2 are dropped.
FaceOverlap overlap(const std::vector<Vec3>& nodes_a, const std::vector<Triangle>& fan_a,
                    const std::vector<Vec3>& nodes_b, const std::vector<Triangle>& fan_b, const Vec3& normal,
                    double tolerance);

} // namespace geom
