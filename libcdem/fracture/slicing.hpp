// Where the parallel planes run that cut one block (Han 2010 section 3): equally spaced, or lined up with a
// crack's tip.
#pragma once

#include "libcdem/fracture/options.hpp"
#include "libcdem/model/model.hpp"

namespace cdem {

// Planes that slice a block; no vertex lies close to one without lying on it (small edges would be the
// result).
struct Slicing {
  geom::Vec3 normal = geom::Vec3::UnitX();
  std::vector<geom::Plane> planes; // all with this normal, offsets ascending
};

// With an anchor that touches the block, planes with the same spacing and one through the anchor; that one
// may be turned a little about the anchor onto an edge or vertex which it would pass close by. Empty when the
// plane through the anchor does not enter the block, or runs back from the anchor.
Slicing slicing(const Block&, const geom::Vec3& normal, const RefineOptions&);

// A place is in the block, or not higher than radius above the face that it is highest over (m).
bool is_near(const Block&, const geom::Vec3& place, double radius);

} // namespace cdem
