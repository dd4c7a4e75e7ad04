// Volume of the overlap of two blocks, or of a meshed block with itself, in their present positions, which contact allows.
//
// The common part of two convex bodies is convex: one cut by all the faces of the other. A block that has deformed need not
// be convex any more, and is taken tetrahedron by tetrahedron, as a mesh is. Of one block, tetrahedra that have a node in common do not count.
#pragma once

#include "libcdem/state/state.hpp"

#include <string>

namespace cdem {

struct Overlap {
  double volume = 0;                     // m3, of all pairs of blocks and of each block with itself
  std::int64_t pairs = 0;                // of blocks that have some in common
  double largest = 0;                    // m3, of one pair
  std::string largest_a, largest_b;      // its blocks, as a user knows them; empty without
  geom::Vec3 place = geom::Vec3::Zero(); // m, of that pair
};

Overlap overlap(const Model&, const State&);

// Two convex blocks that may touch, and overlap though nothing presses them apart: no contact and no joint acts between them.
struct FreeOverlap {
  double part = 0;    // of the volume of the smaller one
  int a = -1, b = -1; // blocks; -1: there are none
};

// The largest, of those with a larger part than this.
FreeOverlap free_overlap(const Model&, const State&, double over);

} // namespace cdem
