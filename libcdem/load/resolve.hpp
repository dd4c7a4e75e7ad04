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

// A flow's pattern follows the faces: it is found again now and then.
struct ResolvedFlow {
  geom::Vec3 direction = geom::Vec3::Zero(); // unit
  std::vector<int> faces;                    // Model::outer_faces
  bool new_faces = false;
  std::size_t load = 0; // its place in ResolvedConditions::varying
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
  std::vector<ResolvedFlow> flows;
  bool has_target = false;
  bool has_initial_stress = false;
};

// Throws geom::InputError when a condition selects nothing.
ResolvedConditions resolve(const Model&, const State&, const Conditions&);

// The patterns of flows for where the faces are now.
void refresh_flows(const Model&, const State&, ResolvedConditions&);

// external at `time`; does nothing when no load varies.
void update_external(ResolvedConditions&, double time);

} // namespace cdem
