// A fan of triangles laid in a plane, and on which side of its edges points lie (used by the overlap of two
// fans).
#pragma once

#include "libgeom/core/types.hpp"

namespace geom {

using Point = Eigen::Vector2d;
using Edge = std::array<int, 2>;

struct PlaneAxes {
  Vec3 origin, e1, e2; // e1 x e2 = normal
  Point flat(const Vec3& x) const { return {e1.dot(x - origin), e2.dot(x - origin)}; }
};

struct FlatFan {
  std::vector<int> node;                // the caller's index of each node
  std::vector<Point> x;                 // m
  std::vector<Triangle> triangles;      // over node, counter-clockwise
  std::vector<Edge> edges;              // over node, smaller first, each once
  std::vector<std::array<int, 3>> edge; // per triangle: edge from corner k to corner k + 1
  std::vector<std::array<int, 3>>
      edge_forward; // per triangle: +1 where it walks that edge from smaller to larger

  // reverse: the fan looks against the normal of the axes.
  FlatFan(const std::vector<Vec3>& nodes, const std::vector<Triangle>& fan, bool reverse, const PlaneAxes&);
};

// Signed distance of every point to the line of every edge of a fan, decided once: within `band` (m) it
// counts as on.
class Sides {
public:
  Sides(const std::vector<Point>& points, const FlatFan& fan, double band);

  double distance(int point, int edge) const {
    return distance_[point * n_edges_ + edge];
  } // m, > 0 on the left
  int sign(int point, int edge) const { return sign_[point * n_edges_ + edge]; }
  bool inside(int point, const FlatFan& fan, int triangle) const;

private:
  std::size_t n_edges_;
  std::vector<double> distance_;
  std::vector<signed char> sign_;
};

} // namespace geom
