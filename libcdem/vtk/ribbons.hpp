// Strips of constant width in pixels along line segments, which face the viewer.
#pragma once

#include "libcdem/vtk/view.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace cdem {

class Ribbons {
public:
  // `lift`: how far in front of the segments, pixels.
  Ribbons(const View& view, double width, double lift) : view_(view), width_(width), lift_(lift) {}

  // Ends are square, or round with the strip's width, or square and drawn out by `extension` pixels.
  void add(const geom::Vec3& from, const geom::Vec3& to, bool round_ends, double extension = 0) {
    geom::Vec3 a = lifted(from), b = lifted(to);
    const geom::Vec3 along = b - a, sight = view_.direction_to_viewer(0.5 * (a + b));
    const geom::Vec3 side = along.cross(sight); // as long as the segment is seen to be
    if (!(side.norm() > shortest * view_.pixel_size(a)) || !view_.in_front(a) || !view_.in_front(b))
      return; // seen from its end, or too small to be seen
    const geom::Vec3 unit = side.normalized();
    if (extension > 0) {
      const geom::Vec3 longer = extension * view_.pixel_size(a) * along.normalized();
      a -= longer;
      b += longer;
    }
    const double ha = 0.5 * width_ * view_.pixel_size(a), hb = 0.5 * width_ * view_.pixel_size(b);
    const int n = static_cast<int>(points.size());
    points.insert(points.end(), {a - ha * unit, b - hb * unit, b + hb * unit, a + ha * unit});
    triangles.push_back({n, n + 1, n + 2});
    triangles.push_back({n, n + 2, n + 3});
    if (round_ends) {
      disc(a, ha);
      disc(b, hb);
    }
  }

  double shortest = 1; // pixels; what is shorter is left out: less for lines in small parts
  std::vector<geom::Vec3> points;
  std::vector<geom::Triangle> triangles;

private:
  geom::Vec3 lifted(const geom::Vec3& x) const {
    return x + lift_ * view_.pixel_size(x) * view_.direction_to_viewer(x);
  }
  void disc(const geom::Vec3& centre, double radius) {
    constexpr int corners = 12;
    const int n = static_cast<int>(points.size());
    for (int i = 0; i < corners; ++i) {
      const double turn = 2 * M_PI * i / corners;
      points.push_back(centre + radius * (std::cos(turn) * view_.right + std::sin(turn) * view_.up));
    }
    for (int i = 1; i + 1 < corners; ++i)
      triangles.push_back({n, n + i, n + i + 1});
  }

  const View& view_;
  double width_, lift_;
};

} // namespace cdem
