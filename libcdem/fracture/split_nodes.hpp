// Frees the nodes of cohesive bodies where a face nears its strength: each node gets a copy for every tet around it
// that a breakable face separates from the others, so that the faces between them can open (element/face_jumps.hpp,
// bond/cohesive_faces.hpp). Freeing moves nothing. The stress stays, and each copy takes the position, the velocity and
// its share of the mass. A preload on the faces between the copies keeps the acceleration; it decays with time. Which
// faces are freed, and when, says fracture/strength_watch.hpp. Where nothing has cracked and the body has come to rest below its
// strength, the copies of a node become one again.
#pragma once

#include "libcdem/state/state.hpp"

#include <vector>

namespace cdem {

struct Freed {
  Model model;
  State state;
  std::vector<int> old_node; // per node, which it was before
  std::vector<char> anew;    // per node, 1 for the copies of those that were not freed before
  std::vector<int> tets;     // of the model, ascending: those around nodes that have been freed or joined
};

// The same model and state with these nodes freed (n_nodes).
Freed split_nodes(const Model&, State, const std::vector<char>& nodes);

// Moves all copies of these nodes (n_nodes; of a node all or none) to their mean place, and gives them their mean velocity,
// by mass. strain_step: s, by which the stress stands behind the nodes. Returns by how much each has moved more than its
// velocity now would tell in that time, m: the stress does not know of it yet.
std::vector<Node> bring_together(const Model&, State&, const std::vector<char>& nodes, double strain_step);

// The same model and state with these nodes freed no more. Their copies have been brought together, and the faces between them
// hold and carry nothing.
Freed join_nodes(const Model&, State, const std::vector<char>& nodes);

// Gives the faces between the copies of these nodes the forces with which all copies of a node have one acceleration, that
// of all of them together, where the net forces (N, n_nodes) alone would pull them apart: differences of a potential that
// solves the graph Laplacian of the copies.
void preload_faces(const Model&, State&, const std::vector<Node>& net_force, const std::vector<char>& nodes);

} // namespace cdem
