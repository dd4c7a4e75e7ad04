// Lowers one body on to others: the distance that it can move along a line before it touches them.
#pragma once

#include "libgeom/mesh/triangle_distance.hpp"

namespace geom {

// A surface as it is seen along one direction.
class Profile {
public:
  Profile(const Surface&, const Mat3& frame); // rows of the frame: two axes across, then up

  struct Face {
    TrianglePoints points; // in the frame
    Eigen::Vector2d low, high;
    double bottom = 0, top = 0;
  };
  std::vector<Face> lower, upper; // faces that look down, up; lower by bottom ascending, upper by top falling
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
};

// Rows: two axes across `up`, and `up`; right-handed.
Mat3 frame_along(const Vec3& up);

// m, least height of the lower side of one body over the upper side of another wherever one is above the other,
// the first moved by `offset` (in the frame); negative when it would have to rise, and `limit` when it is more than
// that or they are nowhere above each other.
double clearance(const Profile& above, const Vec3& offset, const Profile& below, double limit);

} // namespace geom
