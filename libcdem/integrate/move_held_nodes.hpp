// One step of a node of which some components are held: these take the velocity of their support, the others the law of
// the nodes that are free (move_nodes.hpp). A support does the work that the body's own forces do not.
#pragma once

#include "libcdem/integrate/move_nodes.hpp"

namespace cdem {

// `node` is the only one of MovingNodes.
void step_held_node(const MovingNodes& node, const HeldNode&, const Stepping&, NodeSums&);
// previous_force: N, of the step before; replaced.
void relax_held_node(const MovingNodes& node, const HeldNode&, double damping, Node& previous_force,
                     NodeSums&);

} // namespace cdem
