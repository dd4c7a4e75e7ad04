#include "libcdem/load/units_in_water.hpp"

#include "libcdem/element/small_strain.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace cdem {
namespace {

std::vector<double> volume_around_nodes(const Model& model, const Block& block) {
  std::vector<double> volume(static_cast<std::size_t>(block.node_end - block.node_begin), 0.0);
  for (int tet = block.tet_begin; tet < block.tet_end; ++tet)
    for (const int node : model.tets[tet])
      volume[node - block.node_begin] += 0.25 * tet_volume(model, tet);
  return volume;
}

// Per block, the lowest block of those of its body that interfaces join with it: what one unit of many is made of.
std::vector<int> joined_blocks(const Model& model) {
  std::vector<int> first(model.blocks.size());
  std::iota(first.begin(), first.end(), 0);
  const auto root = [&](int b) {
    while (first[b] != b)
      b = first[b] = first[first[b]];
    return b;
  };
  for (const Interface& interface : model.interfaces)
    if (model.blocks[interface.block_a].body == model.blocks[interface.block_b].body) {
      const int a = root(interface.block_a), b = root(interface.block_b);
      first[std::max(a, b)] = std::min(a, b);
    }
  for (std::size_t b = 0; b < first.size(); ++b)
    first[b] = root(static_cast<int>(b));
  return first;
}

} // namespace

void find_units_in_water(const Model& model, const std::vector<int>& shells, ResolvedFlow& flow) {
  const std::vector<int> unit = joined_blocks(model);
  std::vector<int> missing(model.blocks.size(), 0); // outer faces, of each unit at its lowest block
  for (const OuterFace& face : model.outer_faces)
    if (face.boundary < 0 || shells[face.boundary] == 0)
      ++missing[unit[face.block]];
  for (const int face : flow.faces)
    --missing[unit[model.outer_faces[face].block]];
  std::map<int, std::map<int, std::vector<geom::Triangle>>> cavities; // by block and shell
  for (std::size_t t = 0; t < shells.size(); ++t)
    if (shells[t] != 0)
      cavities[model.mesh.boundary[t].block][shells[t]].push_back(model.mesh.boundary[t].nodes);
  constexpr double of_passing = 0.05, of_period = 0.02;
  flow.longest = of_period * flow.water->shortest_period();
  for (BlockInWater& in_water : flow.in_water) {
    const Block& block = model.blocks[in_water.asked.block];
    in_water.inertia = missing[unit[in_water.asked.block]] == 0;
    if (in_water.inertia)
      in_water.volume = volume_around_nodes(model, block);
    if (const auto found = cavities.find(in_water.asked.block); found != cavities.end())
      for (auto& [shell, triangles] : found->second)
        in_water.cavities.push_back(std::move(triangles));
    flow.longest = std::min(flow.longest, of_passing * std::sqrt(block.size / flow.water->gravity()));
  }
}

} // namespace cdem
