// Running bond: courses along x, each shifted against the one below by a fraction of a brick.
#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/check.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

// Joints along one axis, the wall's two ends included. A rest thinner than rounding is no brick.
std::vector<double> joints(double origin, double length, double brick, double first) {
  std::vector<double> at{0};
  const double least = 1e-9 * std::min(brick, length);
  for (int k = 0;; ++k) {
    const double x = first + k * brick;
    if (x >= length - least)
      break;
    if (x > least)
      at.push_back(x);
  }
  at.push_back(length);
  for (double& x : at)
    x += origin;
  return at;
}

} // namespace

Assembly bricks(const BrickOptions& o) {
  require_positive("size", o.size);
  require_positive("brick", o.brick);
  require_finite("origin", o.origin);
  require_between("shift", o.shift, 0, 1);
  const Vec3 per_axis = (o.size.array() / o.brick.array()).ceil();
  require_block_count("brick", text(o.brick), (per_axis.x() + 1) * per_axis.y() * per_axis.z(),
                      "use larger bricks");

  const auto y = joints(o.origin.y(), o.size.y(), o.brick.y(), 0),
             z = joints(o.origin.z(), o.size.z(), o.brick.z(), 0);
  Assembly assembly;
  for (std::size_t course = 0; course + 1 < z.size(); ++course) {
    const double start = std::fmod(static_cast<double>(course) * o.shift, 1.0);
    const auto x = joints(o.origin.x(), o.size.x(), o.brick.x(), start * o.brick.x());
    for (std::size_t j = 0; j + 1 < y.size(); ++j)
      for (std::size_t i = 0; i + 1 < x.size(); ++i)
        assembly.blocks.push_back(make_box({x[i], y[j], z[course]}, {x[i + 1], y[j + 1], z[course + 1]}));
  }
  return assembly;
}

} // namespace geom
