#include "libcdem/contact/field/surface_distance.hpp"

#include "libgeom/query/closest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdem::field {
namespace {

constexpr int few = 4; // triangles of a part that is not split

double distance2(const geom::Box& box, const geom::Vec3& x) {
  return (box.min - x).cwiseMax(x - box.max).cwiseMax(0.0).squaredNorm();
}

} // namespace

SurfaceDistance::SurfaceDistance(std::vector<Corners> triangles) : triangles_(std::move(triangles)) {
  if (triangles_.empty())
    return;
  parts_.push_back({{}, 0, static_cast<int>(triangles_.size()), -1});
  for (int part = 0; part < static_cast<int>(parts_.size()); ++part)
    split(part);
}

void SurfaceDistance::split(int part) {
  const int begin = parts_[part].begin, end = parts_[part].end;
  geom::Box box;
  for (int t = begin; t < end; ++t)
    for (const geom::Vec3& x : triangles_[t])
      box.extend(x);
  parts_[part].box = box;
  if (end - begin <= few)
    return;
  int axis = 0;
  box.size().maxCoeff(&axis);
  const int middle = (begin + end) / 2;
  const auto centre = [&](const Corners& t) { return t[0][axis] + t[1][axis] + t[2][axis]; };
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                   [&](const Corners& a, const Corners& b) { return centre(a) < centre(b); });
  parts_[part].left = static_cast<int>(parts_.size());
  parts_.push_back({{}, begin, middle, -1});
  parts_.push_back({{}, middle, end, -1});
}

void SurfaceDistance::look(int part, const geom::Vec3& x, double& least2) const {
  const Part& at = parts_[part];
  if (distance2(at.box, x) >= least2)
    return;
  if (at.left < 0) {
    for (int t = at.begin; t < at.end; ++t) {
      const Corners& c = triangles_[t];
      const geom::Vec3 w = geom::nearest_on_triangle(x, c[0], c[1], c[2]).weights;
      least2 = std::min(least2, (w[0] * c[0] + w[1] * c[1] + w[2] * c[2] - x).squaredNorm());
    }
    return;
  }
  const bool right_first = distance2(parts_[at.left + 1].box, x) < distance2(parts_[at.left].box, x);
  look(at.left + (right_first ? 1 : 0), x, least2);
  look(at.left + (right_first ? 0 : 1), x, least2);
}

double SurfaceDistance::operator()(const geom::Vec3& x) const {
  double least2 = std::numeric_limits<double>::infinity();
  if (!parts_.empty())
    look(0, x, least2);
  return std::sqrt(least2);
}

} // namespace cdem::field
