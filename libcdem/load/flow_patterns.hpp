// The pattern that a flow finds on the faces (refresh_flows), or of a field of water what it was at the nodes. It holds between
// two looks, also where the model changes and where a stage is left.
#pragma once

#include "libcdem/load/resolve.hpp"

namespace cdem {

struct FlowPatterns {
  struct OfFlow {
    std::vector<std::pair<int, geom::Vec3>> forces; // those of its load
    std::vector<FlowCorner> corners;
    std::vector<AskedWater> asked; // of a field, whose forces and corners follow from it (place_water)
  };
  std::vector<OfFlow> flows;
};

FlowPatterns flow_patterns(const ResolvedConditions&);
void take_flow_patterns(FlowPatterns, ResolvedConditions&); // of the same flows

// Nodes that go on, of bodies that are as they were, keep what was found on their faces before.
// new_node: per node of the model before; -1: of a body that has changed. Blocks keep their numbers.
void keep_flow_patterns(const FlowPatterns& before, const std::vector<int>& new_node, ResolvedConditions&);

} // namespace cdem
