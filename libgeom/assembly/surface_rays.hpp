// On which side of a surface of triangles a point lies, by an upward ray.
#pragma once

#include "libgeom/mesh/surface.hpp"

namespace geom {

class SurfaceRays {
public:
  // The surface must outlive this. A closed one is asked along rays that lean a little: walls that stand upright then make
  // no edge of the drawing in plan meet many others.
  SurfaceRays(const Surface&, bool closed);

  struct Crossings {
    int above = 0, below = 0; // of the point
  };
  Crossings at(const Vec3& point) const;
  bool inside(const Vec3& point) const { return at(point).above % 2 == 1; }

private:
  using Point = Eigen::Vector2d;
  Point flat(const Vec3& x) const { return {x.x() - lean_.x() * x.z(), x.y() - lean_.y() * x.z()}; }
  // Whether b lies left of the line from a to the point, the same answer for every triangle that has this edge; a point on the
  // line counts as moved by an infinitesimal (e, e^2).
  bool left(int a, int b, const Point& point) const;
  std::size_t cell(const Point& x, int axis) const;

  const Surface& surface_;
  Point lean_;
  std::vector<Point> points_; // in plan
  Point low_, cell_size_;
  std::array<std::size_t, 2> cells_{};
  std::vector<std::size_t> first_; // into triangles_, of each cell, and the end
  std::vector<int> triangles_;
};

} // namespace geom
