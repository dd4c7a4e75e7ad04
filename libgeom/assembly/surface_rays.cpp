#include "libgeom/assembly/surface_rays.hpp"

#include <algorithm>
#include <cmath>

namespace geom {

SurfaceRays::SurfaceRays(const Surface& surface, bool closed)
    : surface_(surface), lean_(closed ? Point(0.0123456789, 0.0271828183) : Point(0, 0)) {
  Point high = Point::Constant(-std::numeric_limits<double>::infinity());
  low_ = -high;
  for (const Vec3& x : surface.points) {
    points_.push_back(flat(x));
    low_ = low_.cwiseMin(points_.back());
    high = high.cwiseMax(points_.back());
  }
  const double side = std::sqrt(static_cast<double>(surface.triangles.size()));
  for (int axis = 0; axis < 2; ++axis) {
    cells_[axis] = static_cast<std::size_t>(std::clamp(side, 1.0, 2000.0));
    cell_size_[axis] = std::max((high[axis] - low_[axis]) / static_cast<double>(cells_[axis]), 1e-300);
  }
  // Filled by a counting sort: first how many, then which.
  std::vector<std::size_t> count(cells_[0] * cells_[1] + 1, 0);
  const auto each_cell = [&](const Triangle& t, const auto& visit) {
    const Point least = points_[t[0]].cwiseMin(points_[t[1]]).cwiseMin(points_[t[2]]),
                most = points_[t[0]].cwiseMax(points_[t[1]]).cwiseMax(points_[t[2]]);
    for (std::size_t i = cell(least, 0); i <= cell(most, 0); ++i)
      for (std::size_t j = cell(least, 1); j <= cell(most, 1); ++j)
        visit(i * cells_[1] + j);
  };
  for (const Triangle& t : surface.triangles)
    each_cell(t, [&](std::size_t c) { ++count[c + 1]; });
  for (std::size_t c = 1; c < count.size(); ++c)
    count[c] += count[c - 1];
  first_ = count;
  triangles_.resize(count.back());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    each_cell(surface.triangles[t], [&](std::size_t c) { triangles_[count[c]++] = static_cast<int>(t); });
}

std::size_t SurfaceRays::cell(const Point& x, int axis) const {
  const double place = std::floor((x[axis] - low_[axis]) / cell_size_[axis]);
  return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(cells_[axis] - 1)));
}

bool SurfaceRays::left(int a, int b, const Point& point) const {
  const bool turned = a > b;
  const Point &from = points_[std::min(a, b)], &to = points_[std::max(a, b)];
  const double dx = to.x() - from.x(), dy = to.y() - from.y();
  double side = dx * (point.y() - from.y()) - dy * (point.x() - from.x());
  if (side == 0)
    side = dy != 0 ? -dy : dx;
  return (side > 0) != turned;
}

SurfaceRays::Crossings SurfaceRays::at(const Vec3& x) const {
  Crossings found;
  const Point point = flat(x);
  const Point relative = point - low_;
  for (int axis = 0; axis < 2; ++axis)
    if (!(relative[axis] >= 0 && relative[axis] <= cell_size_[axis] * static_cast<double>(cells_[axis])))
      return found;
  const std::size_t c = cell(point, 0) * cells_[1] + cell(point, 1);
  for (std::size_t k = first_[c]; k < first_[c + 1]; ++k) {
    const Triangle& t = surface_.triangles[triangles_[k]];
    const bool side = left(t[0], t[1], point);
    if (left(t[1], t[2], point) != side || left(t[2], t[0], point) != side)
      continue;
    // Where the ray meets the triangle's plane: by volumes over the corners as they are.
    const Vec3 &a = surface_.points[t[0]], &b = surface_.points[t[1]], &p = surface_.points[t[2]];
    const Vec3 normal = (b - a).cross(p - a), ray(lean_.x(), lean_.y(), 1);
    const double rate = normal.dot(ray);
    if (rate == 0)
      continue;
    (normal.dot(a - x) / rate > 0 ? found.above : found.below) += 1;
  }
  return found;
}

} // namespace geom
