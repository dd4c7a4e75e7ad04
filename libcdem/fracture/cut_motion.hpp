// The motion of a block that is cut goes over to its parts.
#pragma once

#include "libcdem/model/model.hpp"
#include "libcdem/state/state.hpp"

#include <vector>

namespace cdem {

// The velocities of `nodes`, those of the parts of the old block, have been interpolated in it. Their masses are others
// than the old nodes', and so would be momentum, angular momentum and kinetic energy. With W + O x r the rigid motion that
// has the momenta of the new nodes, and V + w x r the one that has those of the old ones,
//
//   v_i <- V + w x r_i + a (v_i - W - O x r_i),   r from the centroid of the new nodes
//
// has the old momenta; a <= 1 is the largest with which the kinetic energy is no larger than before. Blocks that move far
// have the moments of inertia of their solid, cut or not (model/build/convex_inertia): one that moves as a rigid body goes
// on so. With zones that have not, w is made smaller where the spin alone had more energy than there was. A block
// of small strain keeps the w of the old nodes, and so a rigid motion; it does not keep its angular momentum, since its
// parts have less moment of inertia.
void keep_motion(const Model& old, const State& from, int block, const Model& now,
                 const std::vector<int>& nodes, State& state);

} // namespace cdem
