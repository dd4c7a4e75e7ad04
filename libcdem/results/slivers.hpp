// Finds flat or tiny elements that shorten the time step of the whole model.
//
// The stable step of a node is that of the Gershgorin bound (integrate/row_sums.hpp); that of a block is the least of its
// nodes. A convex block is a sliver when its step is less than a third of the median of its body, a tetrahedron of a mesh
// when its least height is. The user is warned if all other elements would allow at least twice the step.
#pragma once

#include "libcdem/model/model.hpp"

#include <string>
#include <vector>

namespace cdem {

struct Slivers { // of one body
  std::string body;
  bool elements = false;           // tetrahedra of a mesh; else convex blocks
  std::int64_t count = 0, of = 0;  // slivers, of how many
  bool cut = false;                // blocks: some have faces of joint sets or cuts with a name
  double step = 0, other_step = 0; // s, stable step with them, and of all that touches none
  // The worst: id of a block, or number of a tetrahedron in its body from 1.
  std::int64_t worst = 0;
  geom::Vec3 place = geom::Vec3::Zero(); // m, undeformed
  double height_over_size = 0; // least height of its tetrahedra over the block's size or its longest edge
};

// Bodies that shorten the stable step of all that deforms; none without.
std::vector<Slivers> find_slivers(const Model&);

} // namespace cdem
