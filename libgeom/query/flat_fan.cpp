#include "libgeom/query/flat_fan.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

// Place of the value in the list, where it is put if it is new. Fans are small: a linear search beats a map.
template <typename T>
int place_of(std::vector<T>& list, const T& value) {
  const auto found = std::find(list.begin(), list.end(), value);
  const int place = static_cast<int>(found - list.begin());
  if (found == list.end())
    list.push_back(value);
  return place;
}

} // namespace

FlatFan::FlatFan(const std::vector<Vec3>& nodes, const std::vector<Triangle>& fan, bool reverse,
                 const PlaneAxes& axes) {
  for (Triangle t : fan) {
    if (reverse)
      std::swap(t[1], t[2]);
    Triangle corners;
    for (int k = 0; k < 3; ++k) {
      corners[k] = place_of(node, t[k]);
      if (node.size() > x.size())
        x.push_back(axes.flat(nodes[t[k]]));
    }
    std::array<int, 3> own_edges, forward;
    for (int k = 0; k < 3; ++k) {
      const int a = corners[k], b = corners[(k + 1) % 3];
      own_edges[k] = place_of(edges, Edge{std::min(a, b), std::max(a, b)});
      forward[k] = a < b ? 1 : -1;
    }
    triangles.push_back(corners);
    edge.push_back(own_edges);
    edge_forward.push_back(forward);
  }
}

Sides::Sides(const std::vector<Point>& points, const FlatFan& fan, double band) : n_edges_(fan.edges.size()) {
  distance_.reserve(points.size() * n_edges_);
  sign_.reserve(points.size() * n_edges_);
  for (const Point& p : points)
    for (const Edge& e : fan.edges) {
      const Point &a = fan.x[e[0]], &b = fan.x[e[1]];
      const Point along = b - a, d = p - a;
      const double length = along.norm();
      // Next to an end the direction of a short edge must not decide.
      const bool at_end = d.norm() <= band || (p - b).norm() <= band || length <= band;
      const double s = at_end ? 0 : (along.x() * d.y() - along.y() * d.x()) / length;
      distance_.push_back(s);
      sign_.push_back(static_cast<signed char>(std::abs(s) <= band ? 0 : s > 0 ? 1 : -1));
    }
}

bool Sides::inside(int point, const FlatFan& fan, int triangle) const {
  for (int k = 0; k < 3; ++k)
    if (sign(point, fan.edge[triangle][k]) * fan.edge_forward[triangle][k] < 0)
      return false;
  return true;
}

} // namespace geom
