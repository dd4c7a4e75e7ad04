// Equal-area projection of directions on the lower hemisphere (Schmidt net). x east, y north; the net has the radius 1.
//
// A line of trend t and plunge p stands at sqrt(2) sin((90 deg - p) / 2) (sin t, cos t). The pole of a plane plunges by
// 90 deg less its dip, against its dip direction (Priest 1985, Hemispherical projection methods in rock mechanics).
#pragma once

#include "libgeom/core/types.hpp"

#include <vector>

namespace geom {

struct Orientation {
  double dip = 0;           // rad, 0..pi/2
  double dip_direction = 0; // rad, 0..2 pi, clockwise from +y (north) seen from above
};

Orientation orientation_of(const Vec3& normal); // of a plane, by either of its normals; longer than zero

// Of a direction, by the one of its two ends that points down; longer than zero.
Eigen::Vector2d on_net(const Vec3& direction);

Eigen::Vector2d pole_on_net(const Orientation&);
// The lines of a plane, from one end of its strike to the other; count >= 2.
std::vector<Eigen::Vector2d> great_circle_on_net(const Orientation&, int count);

} // namespace geom
