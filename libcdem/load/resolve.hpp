// Conditions turned into numbers on nodes: done at the start of a stage and after every change of topology.
#pragma once

#include "libcdem/load/conditions.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

// Nodal pattern of one load that varies in time.
struct VaryingLoad {
  std::vector<std::pair<int, geom::Vec3>> forces; // node, N at amplitude 1
  Amplitude amplitude;
};

struct ResolvedConditions {
  std::vector<Node> free;       // 1 where a component is free, 0 where it is held (n_nodes)
  std::vector<Node> prescribed; // m/s, velocity of the held components (n_nodes)
  std::vector<Node>
      target; // m, displacement the held components are to reach in a relaxation; NaN: none (n_nodes)
  std::vector<Node> constant; // N, loads that do not vary (n_nodes)
  std::vector<Node> external; // N, all loads at the present time (n_nodes)
  std::vector<Node> internal; // N, forces of the initial stress (n_nodes)
  std::vector<VaryingLoad> varying;
  bool has_target = false;
  bool has_initial_stress = false;
};

// Throws geom::InputError when a condition selects nothing.
ResolvedConditions resolve(const Model&, const State&, const Conditions&);

// external at `time`; does nothing when no load varies.
void update_external(ResolvedConditions&, double time);

} // namespace cdem
