#include "libcdem/fracture/star_blocks.hpp"

#include <algorithm>
#include <map>

namespace cdem {
namespace {

// Gives the regions of a block numbers, if each of them is a star, and there are several.
void add_stars(const Model& model, const Block& block, StarBlocks& stars) {
  struct Region {
    std::vector<int> common; // nodes that all its tets have
    geom::Box box;
  };
  const MeshData& mesh = model.mesh;
  std::map<int, Region> regions;
  for (int t = block.tet_begin - mesh.first_tet; t < block.tet_end - mesh.first_tet; ++t) {
    std::vector<int> nodes;
    for (const int node : model.tets[mesh.first_tet + t])
      nodes.push_back(mesh.original[node - mesh.first_node]);
    const auto [at, fresh] = regions.try_emplace(mesh.region[t]);
    Region& region = at->second;
    if (fresh)
      region.common = nodes;
    else
      region.common.erase(std::remove_if(region.common.begin(), region.common.end(),
                                         [&](int node) {
                                           return std::find(nodes.begin(), nodes.end(), node) == nodes.end();
                                         }),
                          region.common.end());
    if (region.common.empty())
      return;
    for (const int node : model.tets[mesh.first_tet + t])
      region.box.extend(model.node_position[node]);
  }
  if (regions.size() < 2)
    return;
  std::map<int, int> number;
  for (const auto& [region, of] : regions) {
    number[region] = static_cast<int>(stars.extent.size());
    const geom::Vec3 extent = of.box.max - of.box.min;
    stars.extent.push_back(extent.minCoeff());
    stars.shape.push_back(extent.minCoeff() / extent.maxCoeff());
  }
  stars.of_tet.resize(model.tets.size() - static_cast<std::size_t>(mesh.first_tet), -1);
  for (int t = block.tet_begin - mesh.first_tet; t < block.tet_end - mesh.first_tet; ++t)
    stars.of_tet[t] = number[mesh.region[t]];
}

} // namespace

bool may_have_stars(const Model& model, const Block& block) {
  const Bonding& bonding = model.bodies[block.body].bonding;
  return !block.convex() && block.rigid < 0 && bonding.is_cohesive() && bonding.between_regions &&
         !bonding.everywhere;
}

StarBlocks star_blocks(const Model& model) {
  StarBlocks stars;
  for (const Block& block : model.blocks)
    if (may_have_stars(model, block))
      add_stars(model, block, stars);
  return stars;
}

} // namespace cdem
