// Units that hang over the ground on a grid, ready to be dropped. Their attitudes are random, and they do not meet in
// any attitude. Rows run across the rise of the ground, the lowest first; layers of them stand on top of each other.
//
// Spheres around the units stand at least 2 R + gap apart, R the radius about the centroid. The lowest layer is
// lowered along z until each unit is `gap` above the ground.
#pragma once

#include "libgeom/placement/ground.hpp"
#include "libgeom/placement/pile.hpp"

namespace geom {

struct DropOptions {
  std::optional<double> gap;     // m; a tenth of the unit's height
  std::optional<PlanBox> region; // over the ground; all of it
  int layers = 0;                // 0: as few as the region allows
  std::uint64_t seed = 1;        // of the attitudes
};

inline constexpr int max_drop_layers = 20;

// Throws InputError for a count below 1, a gap that is not positive, units that miss the ground or do not fit
// over the region in so many layers. A unit of loose parts is hung up as one and falls as many.
Pile drop_grid(const TetMesh& unit, int count, const Ground&, const DropOptions& = {});

} // namespace geom
