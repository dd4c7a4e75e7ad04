// The benchmarks' model: a wall of bonded cubes, held at its foot and pressed from above.
#pragma once

#include "libcdem/load/conditions.hpp"
#include "libcdem/state/state.hpp"

#include <cstddef>

namespace bench {

struct BondedWall {
  cdem::Model model;
  cdem::State state; // at rest
  cdem::Conditions conditions;
  double bytes_per_block =
      0; // on the heap: the model, its state, the copy kept as last good and a stage's workspace
};

// blocks: 100, 10000 or 100000. The last one made is kept, since making a large one takes longer than timing
// it.
const BondedWall& bonded_wall(int blocks);

} // namespace bench
