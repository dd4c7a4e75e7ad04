// Frees the nodes of cohesive bodies where a face nears its strength: each node gets a copy for every tet around it
// that a breakable face separates from the others, so that the faces between them can open (element/face_jumps.hpp,
// bond/cohesive_faces.hpp). Freeing moves nothing. The stress stays, and each copy takes the position, the velocity and
// its share of the mass. A preload on the faces between the copies keeps the acceleration; it decays with time. Faces
// are freed at half their strength, so that a crack finds freed nodes wherever it goes.
#pragma once

#include "libcdem/fracture/working_plane.hpp"
#include "libcdem/state/state.hpp"

#include <optional>

namespace cdem {

class SharedState; // ranks/shared_state.hpp

// Part of its strength at which a face is freed, and from where on it is high time.
inline constexpr double freed_at = 0.5, due_at = 0.7;

class FreeingWatch {
public:
  FreeingWatch() = default; // frees nothing
  explicit FreeingWatch(const Model&);
  bool empty() const { return neighbours_.empty(); } // no body is cohesive

  // Per node of the model, 1 for those of faces between tets whose mean stress uses more than `freed_at` of the strength
  // and which are not freed yet; none unless one uses more than `from`. Stress: that of the state.
  // shared: with several ranks, which look at their own chunks each; null: all are looked at.
  std::optional<std::vector<char>> due(const Model&, const State&, const SharedState* shared, int threads,
                                       double from = due_at) const;

private:
  std::vector<int> neighbours_;   // per tet of the mesh and face of it: 4 tet + face on the other side, or -1
  std::vector<RockStrength> own_; // of the same; empty: all are as their body's joint says
  std::vector<std::vector<UseBound>> bounds_; // of the faces of each chunk; empty likewise
};

struct Freed {
  Model model;
  State state;
  std::vector<int> old_node; // per node, which it was before
  std::vector<char> anew;    // per node, 1 for the copies of those that were not freed before
};

// The same model and state with these nodes freed (n_nodes). The stress of the state must belong to the present
// positions of the nodes.
Freed free_nodes(const Model&, const State&, const std::vector<char>& nodes);

// Gives the faces between the copies of these nodes the forces with which all copies of a node have one acceleration, that
// of all of them together, where the net forces (N, n_nodes) alone would pull them apart: differences of a potential that
// solves the graph Laplacian of the copies.
void preload_faces(const Model&, State&, const std::vector<Node>& net_force, const std::vector<char>& nodes);

} // namespace cdem
