// Velocities stand half a step behind the places. This brings them up to the places by the step's own laws: all that
// moves gets the velocity that the forces give it in that time, a rigid body as a whole.
//
// The next step would do so too, with what moves then. Where a rigid body becomes deformable this is something else: a
// contact would kick a single node for half a step of the rigid body, which is many times as long as a step of the node.
#pragma once

#include "libcdem/load/conditions.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// The state is whole. The work of loads and supports is counted.
void catch_up_velocities(const Model&, State&, const Conditions&);

} // namespace cdem
