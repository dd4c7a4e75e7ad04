// Position of a crack: its tip, and its path from its start.
//
// The crack is the set of springs that are broken, or whose bonds the user removed (a notch), with the triangles
// between them. Distances are measured along these triangles. From one part of the crack to the next the path through
// unbroken rock counts `bridge_cost` times its length. The crack starts at the notch, or without one at the first face
// that broke.
//
// A point of the crack lies on its front when the two sides are still held together there: a path over intact bonds
// around the point leads from one side to the other. The tip is the part of the front that is farthest along the crack;
// the front of a crack that reaches a free surface all round is empty.
#pragma once

#include "libcdem/state/state.hpp"

#include <optional>

namespace cdem {

struct CrackPath {
  // m, undeformed, from the crack's mouth to its end; empty when there is no crack. The shortest way along
  // the crack, so it follows one of its sides where the crack is wide.
  std::vector<geom::Vec3> line;
  geom::Vec3 tip =
      geom::Vec3::Zero(); // m, mean of the farthest front places; the line's end when there is no front
  geom::Vec3 ahead = geom::Vec3::Zero(); // m, the last stretch of the way to the tip; zero when there is none
  bool has_front = false;
  std::vector<int> front_interfaces; // ascending; indices of the intact ones that meet the front
};

// first_break: place of the first spring that broke, the start when the user removed no bonds.
CrackPath crack_path(const Model&, const State&, const std::optional<geom::Vec3>& first_break);

// Volume of each piece that intact bonds hold together, largest first, m3.
std::vector<double> piece_volumes(const Model&, const State&);

} // namespace cdem
