#include "libgeom/core/stereonet.hpp"

#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace geom {

Orientation orientation_of(const Vec3& normal) {
  const Vec3 up = normal.z() < 0 ? Vec3(-normal) : normal;
  const double across = std::hypot(up.x(), up.y());
  Orientation o{portable::atan2(across, up.z()), 0};
  if (across > 0) {
    o.dip_direction = portable::atan2(up.x(), up.y());
    if (o.dip_direction < 0)
      o.dip_direction += 2 * M_PI;
  }
  return o;
}

Eigen::Vector2d on_net(const Vec3& direction) {
  const Vec3 down = (direction.z() > 0 ? Vec3(-direction) : direction).normalized();
  // sin((90 deg - p) / 2) = sqrt((1 - sin p) / 2), over cos p: 1 / sqrt(2 (1 + sin p)).
  return Eigen::Vector2d(down.x(), down.y()) / std::sqrt(1 - down.z());
}

Eigen::Vector2d pole_on_net(const Orientation& o) {
  return -std::sqrt(2.) * portable::sin(0.5 * o.dip) *
         Eigen::Vector2d(portable::sin(o.dip_direction), portable::cos(o.dip_direction));
}

std::vector<Eigen::Vector2d> great_circle_on_net(const Orientation& o, int count) {
  assert(count >= 2);
  const double east = portable::sin(o.dip_direction), north = portable::cos(o.dip_direction);
  const Vec3 strike(-north, east, 0),
      dip(east * portable::cos(o.dip), north * portable::cos(o.dip), -portable::sin(o.dip));
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const double rake = M_PI * i / (count - 1);
    Vec3 line = portable::cos(rake) * strike + portable::sin(rake) * dip;
    line.z() = std::min(line.z(), 0.); // rounding turns no end of the strike round
    points.push_back(on_net(line));
  }
  return points;
}

} // namespace geom
