#include "libcdem/fracture/star_blocks.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace cdem {
namespace {

// Moments of the volume about a place of the region.
struct Moments {
  std::optional<geom::Vec3> about;
  double volume = 0;                      // m3
  geom::Vec3 first = geom::Vec3::Zero();  // m4
  geom::Mat3 second = geom::Mat3::Zero(); // m5

  void add(const std::array<geom::Vec3, 4>& corners) {
    if (!about)
      about = corners[0];
    geom::Vec3 sum = geom::Vec3::Zero();
    geom::Mat3 squares = geom::Mat3::Zero();
    for (const geom::Vec3& corner : corners) {
      const geom::Vec3 x = corner - *about;
      sum += x;
      squares += x * x.transpose();
    }
    const double v =
        (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(corners[3] - corners[0]) / 6;
    volume += v;
    first += v / 4 * sum;
    second += v / 20 * (squares + sum * sum.transpose());
  }
  // The least extent over the largest, whatever its directions: exact for a box.
  double shape() const {
    const geom::Vec3 centre = first / volume;
    const geom::Vec3 squares = Eigen::SelfAdjointEigenSolver<geom::Mat3>(
                                   second / volume - centre * centre.transpose(), Eigen::EigenvaluesOnly)
                                   .eigenvalues(); // ascending
    return std::sqrt(std::max(squares[0], 0.0) / squares[2]);
  }
};

// Gives the regions of a block that are stars numbers, if there are several.
void add_stars(const Model& model, const Block& block, StarBlocks& stars) {
  struct Region {
    std::vector<int> common; // nodes that all its tets have
    Moments moments;
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
    std::array<geom::Vec3, 4> corners;
    for (int k = 0; k < 4; ++k)
      corners[k] = model.node_position[model.tets[mesh.first_tet + t][k]];
    region.moments.add(corners);
  }
  for (auto at = regions.begin(); at != regions.end();)
    at = at->second.common.empty() ? regions.erase(at) : std::next(at);
  if (regions.size() < 2)
    return;
  std::map<int, int> number;
  for (const auto& [region, of] : regions) {
    number[region] = static_cast<int>(stars.shape.size());
    stars.shape.push_back(of.moments.shape());
  }
  stars.of_tet.resize(model.tets.size() - static_cast<std::size_t>(mesh.first_tet), -1);
  for (int t = block.tet_begin - mesh.first_tet; t < block.tet_end - mesh.first_tet; ++t)
    if (const auto at = number.find(mesh.region[t]); at != number.end())
      stars.of_tet[t] = at->second;
}

// By the bonding of its body alone.
bool may_have_stars(const Model& model, const Block& block) {
  const Bonding& bonding = model.bodies[block.body].bonding;
  return !block.convex() && block.rigid < 0 && bonding.is_cohesive() && bonding.between_regions &&
         !bonding.everywhere;
}

} // namespace

StarBlocks star_blocks(const Model& model) {
  StarBlocks stars;
  for (const Block& block : model.blocks)
    if (may_have_stars(model, block))
      add_stars(model, block, stars);
  return stars;
}

} // namespace cdem
