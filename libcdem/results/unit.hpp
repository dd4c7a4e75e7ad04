// A unit, one of the blocks of a body, as it is now.
#pragma once

#include "libgeom/placement/pile.hpp"

namespace cdem {

struct Unit {
  int block = 0;                            // of the model
  geom::Vec3 centroid = geom::Vec3::Zero(); // m, now
  geom::Pose motion;                        // the rigid one nearest to how its mass has moved since the start
};

} // namespace cdem
