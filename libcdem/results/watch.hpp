// Finds the units of a pile that have left their position, in order.
//
// A unit has left when its centroid has moved by `leaves` in two measures. The first is relative to the mean motion of
// the blocks that it touched when the watch was made: so a pile that sinks or slides as a whole loses no unit. The
// second is relative to the ground: so a unit whose neighbours move away has not left. Neighbours that have left do not
// count in the mean, otherwise a unit on which they rested would seem to move. A unit without neighbours, or whose
// neighbours have all left, is measured relative to the ground alone.
//
// A unit that breaks leaves piece by piece, by the same rule for each piece of at least a twentieth of it. The unit is
// gone when less than a twentieth is left.
#pragma once

#include "libcdem/state/state.hpp"

#include <string>

namespace cdem {

// A unit that has left, at the look that found it so.
struct Departure {
  int unit = 0;                                 // of its body, from 1
  std::int64_t step = 0;                        // over all stages
  double time = 0;                              // s
  double velocity = 0;                          // m/s, of the flow then; NaN without one
  geom::Vec3 displacement = geom::Vec3::Zero(); // m, since the watch was made, relative to what it touched
  geom::Vec3 place = geom::Vec3::Zero();        // m, of the centroid
  double share = 1;                             // of the unit's volume; below 1: a piece of it
};

struct Watch {
  double leaves = 0;                     // m
  std::vector<int> blocks;               // the body's units, in order
  std::vector<int> numbers;              // of these, from 1 (n units)
  std::vector<std::vector<int>> touched; // by each of them when the watch was made, ascending (n units)
  std::vector<geom::Vec3> start;         // m, centroids of all blocks then (n_blocks)
  std::vector<std::uint8_t> gone;        // (n_blocks) has left
  std::vector<Departure> left;           // in order; of one look by unit
  // The tetrahedra of units that can break, block by block: centroids when the watch was made, m, and the step in which
  // each left with its piece, -1 while it has not.
  std::vector<geom::Vec3> tet_start;
  std::vector<std::int64_t> tet_left;
};

// Begins a watch of a body of meshes; throws geom::InputError.
Watch start_watch(const Model&, const State&, const std::string& body, double leaves);

void look(const Model&, const State&, double flow_velocity, Watch&);

// As it stood at a step (over all stages) that has passed.
Watch watch_at(const Watch&, std::int64_t step);

} // namespace cdem
