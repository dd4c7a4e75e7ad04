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
// The nodes `range` of a model; nodes(part) gives the MovingNodes of a part of it.
template <class Nodes>
void step_nodes_and_held(const ResolvedConditions& r, Range range, const Nodes& nodes, const Stepping& s,
                         NodeSums& sums) {
  each_node(
      r, range, [&](Range part) { step_nodes(nodes(part), s, sums); },
      [&](const HeldNode& h) {
        const MovingNodes node = nodes(Range{h.node, h.node + 1});
        if (h.dashpot < 0)
          step_held_node(node, h, s, sums);
        else
          step_dashpot_node(node, h, r.dashpots[h.dashpot], s, sums);
      });
}

// previous_force: N, of the step before; replaced.
void relax_held_node(const MovingNodes& node, const HeldNode&, double damping, Node& previous_force,
                     NodeSums&);

} // namespace cdem
