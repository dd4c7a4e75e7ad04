// Walls around a pile, as of a flume: upright boxes whose inner faces stand at the ends of the pile's box, at both sides
// and at the foot of the slope, on level ground all round. They stand on the ground, a little above it, so that the two
// do not meet, and are equally high over it everywhere.
#pragma once

#include "libgeom/placement/ground.hpp"
#include "libgeom/placement/pile.hpp"

#include <optional>

namespace geom {

struct WallOptions {
  std::optional<double> height;    // m, over the ground; as high as the highest unit, two units at least
  std::optional<double> thickness; // m; a unit's height
};

// Between the walls and the ground and between two walls, over the unit's height: no unit fits through.
inline constexpr double wall_clearance = 0.05;

// One mesh of as many parts as there are walls. Throws InputError for a pile without units, sizes that are not positive.
TetMesh walls_around(const Pile&, const Ground&, const WallOptions& = {});

} // namespace geom
