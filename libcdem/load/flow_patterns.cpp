#include "libcdem/load/flow_patterns.hpp"

#include <algorithm>
#include <utility>

namespace cdem {
namespace {

// What the field was at a block that is as it was. first_node: of the block then; -1: it has changed.
void keep_water(const AskedWater& old, int first_node, AskedWater& block) {
  if (old.block != block.block || old.nodes.size() != block.nodes.size() || first_node != block.first_node)
    return;
  block.time = old.time;
  block.nodes = old.nodes;
  block.cracks = old.cracks;
  block.bared = old.bared;
  for (CrackSide& side : block.cracks) {
    side.block = block.block;
    for (int& node : side.nodes)
      node += first_node - old.first_node;
  }
  for (auto& [face, parted] : block.bared) {
    face.block = block.block;
    for (auto& [node, area] : face.node_area)
      node += first_node - old.first_node;
  }
}

} // namespace

FlowPatterns flow_patterns(const ResolvedConditions& r) {
  FlowPatterns patterns;
  for (const ResolvedFlow& flow : r.flows)
    if (flow.water) {
      std::vector<AskedWater>& asked = patterns.flows.emplace_back().asked;
      for (const BlockInWater& in_water : flow.in_water)
        asked.push_back(in_water.asked);
    } else {
      patterns.flows.push_back({r.varying[flow.load].forces, flow.corners, {}});
    }
  return patterns;
}

void take_flow_patterns(FlowPatterns patterns, ResolvedConditions& r) {
  if (patterns.flows.size() != r.flows.size())
    return;
  for (std::size_t i = 0; i < r.flows.size(); ++i) {
    if (r.flows[i].water) {
      const std::vector<AskedWater>& kept = patterns.flows[i].asked;
      for (std::size_t b = 0; b < std::min(kept.size(), r.flows[i].in_water.size()); ++b)
        keep_water(kept[b], kept[b].first_node, r.flows[i].in_water[b].asked);
      continue;
    }
    std::vector<std::pair<int, geom::Vec3>>& forces = r.varying[r.flows[i].load].forces;
    for (const auto& [node, force] : forces)
      r.external[node] = r.constant[node];
    forces = std::move(patterns.flows[i].forces);
    r.flows[i].corners = std::move(patterns.flows[i].corners);
  }
}

void keep_flow_patterns(const FlowPatterns& before, const std::vector<int>& new_node, ResolvedConditions& r) {
  const FlowPatterns found = flow_patterns(r);
  if (found.flows.empty() || found.flows.size() != before.flows.size())
    return;
  std::vector<char> goes_on(r.external.size(), 0);
  for (const int node : new_node)
    if (node >= 0)
      goes_on[node] = 1;
  FlowPatterns all;
  for (std::size_t i = 0; i < found.flows.size(); ++i) {
    const FlowPatterns::OfFlow &old = before.flows[i], &now = found.flows[i];
    FlowPatterns::OfFlow flow;
    const auto add = [&](const FlowCorner& corner, int node) {
      flow.corners.push_back({node, corner.inward, corner.stream});
      flow.forces.emplace_back(node, geom::Vec3::Zero());
    };
    for (const FlowCorner& corner : old.corners)
      if (const int node = new_node[corner.node]; node >= 0)
        add(corner, node);
    for (const FlowCorner& corner : now.corners)
      if (goes_on[corner.node] == 0)
        add(corner, corner.node);
    for (std::size_t k = old.corners.size(); k < old.forces.size(); ++k)
      if (const int node = new_node[old.forces[k].first]; node >= 0)
        flow.forces.emplace_back(node, old.forces[k].second);
    for (std::size_t k = now.corners.size(); k < now.forces.size(); ++k)
      if (goes_on[now.forces[k].first] == 0)
        flow.forces.push_back(now.forces[k]);
    flow.asked = now.asked;
    for (std::size_t b = 0; b < std::min(now.asked.size(), old.asked.size()); ++b)
      keep_water(old.asked[b], new_node[old.asked[b].first_node], flow.asked[b]);
    all.flows.push_back(std::move(flow));
  }
  take_flow_patterns(std::move(all), r);
}

} // namespace cdem
