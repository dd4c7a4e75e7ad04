// Carries a State over to a model of another topology. fracture/ changes models and says by a map where each entry comes
// from; this is the only code that moves fields, and the table (state/fields.inc) says what becomes of each.
#pragma once

#include "libcdem/state/state.hpp"

#include <Eigen/Core>
#include <functional>
#include <optional>

namespace cdem {

// A node that lies in a tet of the old model and was no node there.
struct BlendedNode {
  int node = 0;
  geom::Tet tet{};         // old nodes
  Eigen::Vector4d weights; // their sum is 1
};

// An old node gives this part of what it has to a new one.
struct SharedNode {
  int old_node = 0, node = 0;
  double part = 0;
};

// Old numbers by new ones, -1: new. Without a map, all entries of a place stay what they are.
struct TopologyMap {
  template <class Number>
  using Map = std::optional<std::vector<Number>>;

  Map<int> node;                    // (n_nodes); -1 also for those that are blended
  std::vector<BlendedNode> blended; // of parts of old blocks
  std::vector<SharedNode> divided;  // of fields that are divided, wherever `node` is given
  Map<int> tet;                     // (n_tets)
  Map<std::int64_t> face;           // (n face batches * lanes): place
  Map<int> bond;                    // (n_points)
  Map<int> frame;                   // (n frames)
  Map<int> rigid_body;              // (n rigid bodies)
  // New numbers by old ones: triangles of the contact surface; -1: gone, with its contacts.
  Map<int> new_triangle;
  // Per node of the new model, the smallest node that it hangs together with (bond/fragments.hpp); for contacts.
  std::function<std::vector<int>(const Model&, const State&)> fragments_of_nodes;
};

// That of a model whose arrays by tet of meshes are left empty: they are taken from another State.
State initial_state_without_tets(const Model&);

// now: the model that the map leads to.
void carry(const Model& old, const Model& now, const TopologyMap&, State&);

} // namespace cdem
