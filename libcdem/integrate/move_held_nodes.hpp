// One step of a node of which some components are held: these take the velocity of their support, the others the law of
// the nodes that are free (move_nodes.hpp). A support does the work that the body's own forces do not.
#pragma once

#include "libcdem/integrate/move_nodes.hpp"

namespace cdem {

// `node` is the only one of MovingNodes.
void step_held_node(const MovingNodes& node, const HeldNode&, const Stepping&, NodeSums&);
// One on which a dashpot C acts, of which components may be held too; C in N s/m, symmetric. It acts on the mean velocity
// of the step, so that it does not shorten the stable step: (m/dt + C/2) v+ = (m/dt - C/2) v- + F. Local damping leaves
// the node alone.
void step_dashpot_node(const MovingNodes& node, const HeldNode&, const geom::Mat3& dashpot, const Stepping&,
                       NodeSums&);
// previous_force: N, of the step before; replaced.
void relax_held_node(const MovingNodes& node, const HeldNode&, double damping, Node& previous_force,
                     NodeSums&);

} // namespace cdem
