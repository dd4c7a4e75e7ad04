// Overlap of two fans of triangles in one plane. Signs come first, coordinates second: the side of each node
// against each edge of the other fan is decided once, and every pair of triangles reads its corners off that
// table. Neighbouring pairs therefore agree on the points between them, and slivers cannot tear the tiling.
#include "libgeom/query/face_overlap.hpp"
#include "libgeom/core/portable.hpp"
#include "libgeom/query/flat_fan.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

double cross(const Point& a, const Point& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Where a point lies in one fan: nodes in the fan's own numbering and their weights.
struct Location {
  std::array<int, 3> nodes;
  std::array<double, 3> weights;
};

Location at_node(int n) {
  return {{n, n, n}, {1, 0, 0}};
}

Location on_edge(const FlatFan& fan, const Edge& e, const Point& p) {
  const Point along = fan.x[e[1]] - fan.x[e[0]];
  const double share = std::clamp(along.dot(p - fan.x[e[0]]) / along.squaredNorm(), 0.0, 1.0);
  return {{e[0], e[1], e[0]}, {1 - share, share, 0}};
}

Location in_triangle(const FlatFan& fan, int triangle, const Point& p) {
  const Triangle& t = fan.triangles[triangle];
  Eigen::Matrix2d m;
  m << fan.x[t[1]] - fan.x[t[0]], fan.x[t[2]] - fan.x[t[0]];
  const Point w = m.fullPivLu().solve(p - fan.x[t[0]]); // pivoted: reproduces p also in a sliver
  return {t, {1 - w.x() - w.y(), w.x(), w.y()}};
}

Location snapped(const FlatFan& fan, const Location& location, const Point& p, double tolerance) {
  for (int n : location.nodes)
    if ((fan.x[n] - p).norm() <= tolerance)
      return at_node(n);
  return location;
}

// Location of node `point` of the other fan, which lies in at least one triangle of this one.
Location locate(const FlatFan& fan, const Sides& sides, int point, const Point& p) {
  for (std::size_t t = 0; t < fan.triangles.size(); ++t) {
    if (!sides.inside(point, fan, static_cast<int>(t)))
      continue;
    for (int e : fan.edge[t])
      if (sides.sign(point, e) == 0)
        return on_edge(fan, fan.edges[e], p);
    return in_triangle(fan, static_cast<int>(t), p);
  }
  return in_triangle(fan, 0, p);
}

struct Candidate {
  int node_a, node_b; // the nodes it sits on, or -1
  int edge_a, edge_b; // the edges that cross in it, or -1
  Point p;
  double area;
};

class Overlapper {
public:
  Overlapper(FlatFan a, FlatFan b, double band, double tolerance)
      : a_(std::move(a)), b_(std::move(b)), band_(band), tolerance_(tolerance), twin_of_a_(a_.x.size(), -1),
        twin_of_b_(b_.x.size(), -1), at_a_(a_.x.size(), -1), at_b_(b_.x.size(), -1) {}

  FaceOverlap run(const std::vector<Vec3>& nodes_a) {
    pair_nodes();
    std::vector<char> done_a(a_.triangles.size(), 0), done_b(b_.triangles.size(), 0);
    take_equal_triangles(done_a, done_b);
    a_in_b_ = Sides(a_.x, b_, band_);
    b_in_a_ = Sides(b_.x, a_, band_);
    for (std::size_t i = 0; i < a_.triangles.size(); ++i)
      for (std::size_t j = 0; j < b_.triangles.size(); ++j)
        if (!done_a[i] && !done_b[j])
          overlap_triangles(static_cast<int>(i), static_cast<int>(j));
    return collect(nodes_a);
  }

private:
  // Nodes of b within the tolerance of a node of a take its place.
  void pair_nodes() {
    for (std::size_t j = 0; j < b_.x.size(); ++j) {
      int nearest = -1;
      double least = tolerance_;
      for (std::size_t i = 0; i < a_.x.size(); ++i)
        if (twin_of_a_[i] < 0 && (a_.x[i] - b_.x[j]).norm() <= least) {
          nearest = static_cast<int>(i);
          least = (a_.x[i] - b_.x[j]).norm();
        }
      if (nearest >= 0) {
        twin_of_b_[j] = nearest;
        twin_of_a_[nearest] = static_cast<int>(j);
        b_.x[j] = a_.x[nearest];
      }
    }
  }

  // Matching faces need no clipping: triangles that are the same on both sides overlap in themselves alone.
  void take_equal_triangles(std::vector<char>& done_a, std::vector<char>& done_b) {
    const auto sorted = [](Triangle t) {
      std::sort(t.begin(), t.end());
      return t;
    };
    for (std::size_t j = 0; j < b_.triangles.size(); ++j) {
      const Triangle& t = b_.triangles[j];
      const Triangle twin = sorted({twin_of_b_[t[0]], twin_of_b_[t[1]], twin_of_b_[t[2]]});
      for (std::size_t i = 0; i < a_.triangles.size(); ++i)
        if (!done_a[i] && sorted(a_.triangles[i]) == twin) {
          done_a[i] = done_b[j] = 1;
          corners_.clear();
          for (int n : a_.triangles[i])
            corners_.push_back(candidate_at_a(n));
          add_polygon();
        }
    }
  }

  int candidate_at_a(int n) {
    if (at_a_[n] < 0)
      at_a_[n] = new_candidate({n, twin_of_a_[n], -1, -1, a_.x[n], 0});
    return at_a_[n];
  }

  int candidate_at_b(int n) {
    if (twin_of_b_[n] >= 0)
      return candidate_at_a(twin_of_b_[n]);
    if (at_b_[n] < 0)
      at_b_[n] = new_candidate({-1, n, -1, -1, b_.x[n], 0});
    return at_b_[n];
  }

  // Crossing of two edges, or -1. Computed once per pair of edges: all triangles along them see the same
  // point.
  int candidate_at_crossing(int edge_a, int edge_b) {
    const Edge &ea = a_.edges[edge_a], &eb = b_.edges[edge_b];
    if (a_in_b_.sign(ea[0], edge_b) * a_in_b_.sign(ea[1], edge_b) >= 0 ||
        b_in_a_.sign(eb[0], edge_a) * b_in_a_.sign(eb[1], edge_a) >= 0)
      return -1;
    for (std::size_t c = 0; c < candidates_.size(); ++c)
      if (candidates_[c].edge_a == edge_a && candidates_[c].edge_b == edge_b)
        return static_cast<int>(c);
    const double d0 = a_in_b_.distance(ea[0], edge_b), d1 = a_in_b_.distance(ea[1], edge_b);
    const Point p = a_.x[ea[0]] + d0 / (d0 - d1) * (a_.x[ea[1]] - a_.x[ea[0]]);
    return new_candidate({-1, -1, edge_a, edge_b, p, 0});
  }

  int new_candidate(const Candidate& c) {
    candidates_.push_back(c);
    return static_cast<int>(candidates_.size()) - 1;
  }

  bool boxes_apart(int i, int j) const {
    const Triangle &t = a_.triangles[i], &u = b_.triangles[j];
    const auto low = [](const FlatFan& f, const Triangle& c) {
      return Point(f.x[c[0]].cwiseMin(f.x[c[1]]).cwiseMin(f.x[c[2]]));
    };
    const auto high = [](const FlatFan& f, const Triangle& c) {
      return Point(f.x[c[0]].cwiseMax(f.x[c[1]]).cwiseMax(f.x[c[2]]));
    };
    return (low(a_, t).array() > high(b_, u).array() + band_).any() ||
           (low(b_, u).array() > high(a_, t).array() + band_).any();
  }

  void overlap_triangles(int i, int j) {
    if (boxes_apart(i, j))
      return;
    corners_.clear();
    for (int n : a_.triangles[i])
      if (a_in_b_.inside(n, b_, j))
        corners_.push_back(candidate_at_a(n));
    for (int n : b_.triangles[j])
      if (b_in_a_.inside(n, a_, i))
        corners_.push_back(candidate_at_b(n));
    for (int ea : a_.edge[i])
      for (int eb : b_.edge[j])
        if (const int c = candidate_at_crossing(ea, eb); c >= 0)
          corners_.push_back(c);
    add_polygon();
  }

  double doubled_area(int i, int j, int k) const {
    const Point& o = candidates_[i].p;
    return cross(candidates_[j].p - o, candidates_[k].p - o);
  }

  // Puts the convex polygon over corners_ in order, adds its area at its corners and its triangles to the
  // tiling.
  void add_polygon() {
    std::sort(corners_.begin(), corners_.end());
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
    const std::size_t n = corners_.size();
    if (n < 3)
      return;
    Point middle = Point::Zero();
    for (int c : corners_)
      middle += candidates_[c].p / static_cast<double>(n);
    std::vector<std::pair<double, int>>& order = order_;
    order.clear();
    for (int c : corners_) {
      const Point d = candidates_[c].p - middle;
      order.emplace_back(portable::atan2(d.y(), d.x()), c);
    }
    std::sort(order.begin(), order.end());
    double area = 0, perimeter = 0;
    for (std::size_t k = 0; k < n; ++k) {
      corners_[k] = order[k].second;
      const Point &p = candidates_[order[k].second].p, &q = candidates_[order[(k + 1) % n].second].p;
      area += 0.5 * cross(p - middle, q - middle);
      perimeter += (q - p).norm();
    }
    if (area <= std::max(band_ * perimeter, tolerance_ * tolerance_))
      return;
    area_ += area;

    // A third of each triangle's area stands at its corners. The mean over the fans about every corner keeps
    // the symmetry of the polygon, which one fan would break.
    double widest = -1;
    std::size_t apex = 0;
    for (std::size_t k = 0; k < n; ++k) {
      double narrowest = std::numeric_limits<double>::infinity();
      for (std::size_t m = 1; m + 1 < n; ++m) {
        const int i = corners_[k], j = corners_[(k + m) % n], l = corners_[(k + m + 1) % n];
        const double doubled = doubled_area(i, j, l);
        for (int c : {i, j, l})
          candidates_[c].area += doubled / (6 * static_cast<double>(n));
        narrowest = std::min(narrowest, doubled);
      }
      if (narrowest > widest) {
        widest = narrowest;
        apex = k;
      }
    }
    for (std::size_t m = 1; m + 1 < n; ++m)
      triangles_.push_back({corners_[apex], corners_[(apex + m) % n], corners_[(apex + m + 1) % n]});
  }

  Location location_in_a(const Candidate& c) const {
    return c.node_a >= 0   ? at_node(c.node_a)
           : c.edge_a >= 0 ? snapped(a_, on_edge(a_, a_.edges[c.edge_a], c.p), c.p, tolerance_)
                           : snapped(a_, locate(a_, b_in_a_, c.node_b, c.p), c.p, tolerance_);
  }
  Location location_in_b(const Candidate& c) const {
    return c.node_b >= 0   ? at_node(c.node_b)
           : c.edge_b >= 0 ? snapped(b_, on_edge(b_, b_.edges[c.edge_b], c.p), c.p, tolerance_)
                           : snapped(b_, locate(b_, a_in_b_, c.node_a, c.p), c.p, tolerance_);
  }

  // Merges points nearer than the tolerance, nodes of a before nodes of b before crossings, and writes the
  // result.
  FaceOverlap collect(const std::vector<Vec3>& nodes_a) {
    const auto rank = [&](int c) {
      return candidates_[c].node_a >= 0 ? 0 : candidates_[c].node_b >= 0 ? 1 : 2;
    };
    std::vector<int> used;
    for (std::size_t c = 0; c < candidates_.size(); ++c)
      if (candidates_[c].area > 0)
        used.push_back(static_cast<int>(c));
    std::stable_sort(used.begin(), used.end(), [&](int c, int d) { return rank(c) < rank(d); });

    FaceOverlap result;
    std::vector<int> kept, place(candidates_.size(), -1);
    for (int c : used) {
      for (std::size_t k = 0; k < kept.size() && place[c] < 0; ++k)
        if ((candidates_[kept[k]].p - candidates_[c].p).norm() <= tolerance_)
          place[c] = static_cast<int>(k);
      if (place[c] >= 0) {
        result.points[place[c]].area += candidates_[c].area;
        continue;
      }
      place[c] = static_cast<int>(kept.size());
      kept.push_back(c);
      const Location in_a = location_in_a(candidates_[c]), in_b = location_in_b(candidates_[c]);
      OverlapPoint point;
      point.area = candidates_[c].area;
      point.weights_a = in_a.weights;
      point.weights_b = in_b.weights;
      point.position = Vec3::Zero();
      for (int k = 0; k < 3; ++k) {
        point.nodes_a[k] = a_.node[in_a.nodes[k]];
        point.nodes_b[k] = b_.node[in_b.nodes[k]];
        point.position += in_a.weights[k] * nodes_a[point.nodes_a[k]];
      }
      result.points.push_back(point);
    }
    for (const Triangle& t : triangles_) {
      const Triangle merged{place[t[0]], place[t[1]], place[t[2]]};
      if (merged[0] != merged[1] && merged[1] != merged[2] && merged[2] != merged[0])
        result.triangles.push_back(merged);
    }
    result.area = area_;
    return result;
  }

  FlatFan a_, b_;
  double band_, tolerance_;
  std::vector<int> twin_of_a_, twin_of_b_; // node of the other fan at the same place, or -1
  std::vector<int> at_a_, at_b_;           // candidate at a node, or -1
  Sides a_in_b_{{}, a_, 0}, b_in_a_{{}, b_, 0};
  std::vector<Candidate> candidates_;
  std::vector<Triangle> triangles_; // over candidates_
  double area_ = 0;
  std::vector<int> corners_;
  std::vector<std::pair<double, int>> order_;
};

} // namespace

FaceOverlap overlap(const std::vector<Vec3>& nodes_a, const std::vector<Triangle>& fan_a,
                    const std::vector<Vec3>& nodes_b, const std::vector<Triangle>& fan_b, const Vec3& normal,
                    double tolerance) {
  if (fan_a.empty() || fan_b.empty())
    return {};
  Box box;
  for (const Triangle& t : fan_a)
    for (int n : t)
      box.extend(nodes_a[n]);
  const Vec3 e1 = normal.unitOrthogonal();
  const PlaneAxes axes{box.centre(), e1, normal.cross(e1)};
  FlatFan a(nodes_a, fan_a, false, axes), b(nodes_b, fan_b, true, axes);
  // What rounding alone does to the coordinates: of the plane's own lengths, and of a model far from the
  // origin.
  const double band =
      1e-13 * box.size().norm() + 8 * std::numeric_limits<double>::epsilon() *
                                      std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  return Overlapper(std::move(a), std::move(b), band, std::max(tolerance, 4 * band)).run(nodes_a);
}

} // namespace geom
