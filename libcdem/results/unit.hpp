// A unit, one of the blocks of a body, as it is now.
#pragma once

#include "libgeom/placement/pile.hpp"

namespace cdem {

// The largest piece of a broken unit gives its centroid and motion.
struct Unit {
  int block = 0;                            // of the model
  geom::Vec3 centroid = geom::Vec3::Zero(); // m, now
  geom::Pose motion;                        // the rigid one nearest to how its mass has moved since the start
  int pieces = 1;                           // that no bond holds together
  double largest_piece = 1;                 // part of its volume
};

} // namespace cdem
