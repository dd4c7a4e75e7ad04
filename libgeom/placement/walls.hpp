// Walls around a pile, as in a flume: upright boxes whose inner faces stand at the ends of the pile's box. On a slope
// there are walls at both sides and at the foot; on level ground they stand all round. Their lower edges are a little
// above the ground, so that walls and ground do not meet. The height above the ground is the same everywhere.
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
