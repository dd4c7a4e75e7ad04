// Two rigid convex blocks near each other, and how far they have moved relative to each other.
//
// Seen from block a with the pose (c_a, R_a) the pose of block b is p = R_a^T (c_b - c_a), Q = R_a^T R_b. Between two
// moments no place of b moves further relative to a than |p' - p| + |Q' - Q| r_b, with r_b the radius of b around its
// centroid. Nor do the two come nearer to each other than by the paths of their fastest nodes. Either turns b relative to a
// by no more than itself over the smaller of the two inner radii: a block holds a ball of that radius, and some node of it moves
// as far as the ball's surface does.
#pragma once

#include "libgeom/core/types.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace cdem {

struct BodyPose {
  geom::Vec3 centre = geom::Vec3::Zero();     // m
  std::array<double, 4> rotation{1, 0, 0, 0}; // unit quaternion w x y z
};

// What a pair has moved is counted on from search to search: its rows keep lengths on this scale.
struct RigidPair {
  int a = 0, b = 0;                            // blocks; b has the smaller radius
  double radius_b = 0;                         // m, of the nodes of b around its centroid
  double turns = 0;                            // rad/m, at most, that b turns seen from a, over what it moves
  double skin = 0;                             // m, relative motion that its candidates allow for
  std::int64_t at = 0;                         // steps of contact when it was searched
  int doublings = 0;                           // how often its thinnest skin was doubled
  BodyPose at_search;                          // b seen from a, when it was searched
  BodyPose at_look;                            // the same when `base` was taken
  double path_at_search = 0, path_at_look = 0; // m, of both blocks, then
  double base = 0;                             // m, moved until at_look
  double moved = 0;                            // m, at most, when it was last looked at
  double from =
      0; // m, what is found when it was last looked at and is d away waits until `moved` is from + d
  double threshold = 0;         // m, motion since at_look, at which at_look is renewed
  double leaves_at = 0;         // m, path of both at which it may have left its skin
  double look_at = 0;           // m, path of both before which none of its rows is due
  std::array<double, 2> next{}; // m, of `moved`, before which no row of springs, of edges is due
  // Planes of faces that part the two best, by number, those of a first; -1: none. No other one does before others_until,
  // m, of `moved`.
  std::array<int, 4> planes{-1, -1, -1, -1};
  double others_until = 0;
};

// Blocks that are rigid, convex and bonded to no other, and their pairs.
struct RigidPairs {
  // Per block, written by find_pairwise: 1 if it is such a block; of those, the radii, and triangles in the planes of their
  // faces, by number.
  std::vector<char> pairwise;
  std::vector<double> radius, inner_radius; // m, around the centroid: all nodes are within, no face is
  std::vector<std::vector<int>> planes;
  // Per block, how it stands, and the path of its fastest node, m, never less than it was.
  std::vector<BodyPose> pose;
  std::vector<double> path;
  std::vector<RigidPair> all; // of those near each other, by their two numbers
  std::int64_t steps = 0;     // of contact, since the stage began
};

} // namespace cdem
