#include "libcdem/model/build/light_corners.hpp"

#include "libcdem/model/build/split_mesh.hpp"
#include "libcdem/model/build/star_row_sums.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <map>
#include <numeric>

namespace cdem {
namespace {

constexpr double most_moved = 1e-3;    // of the block's mass
constexpr double part_of_median = 0.5; // of the nodes' steps

struct Corner {
  double stiffness = 0;                           // K, N/m
  double mass = 0;                                // kg
  double own() const { return mass / stiffness; } // s2, a quarter of its step squared
};

// s2, the largest q at most `goal` with sum (K q - m)+ <= mass; corners: by their own q, ascending.
double reachable(const std::vector<Corner>& corners, double goal, double mass) {
  double stiffness = 0, q = 0;
  for (const Corner& corner : corners) {
    const double next = std::min(corner.own(), goal);
    if (stiffness * (next - q) > mass)
      break;
    mass -= stiffness * (next - q);
    q = next;
    stiffness += corner.stiffness;
  }
  return std::min(goal, q + mass / stiffness);
}

} // namespace

void raise_light_corners(const Elastic& material, StarMasses& star) {
  const std::vector<double> sums = star_row_sums(material, star.nodes, star.tets);
  const std::size_t centre = star.nodes.size() - 1;
  const double mass = std::accumulate(star.mass.begin(), star.mass.end(), 0.0);
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < centre; ++i)
    corners.push_back({sums[i], star.mass[i]});
  std::sort(corners.begin(), corners.end(),
            [](const Corner& l, const Corner& r) { return l.own() < r.own(); });
  const double goal = part_of_median * part_of_median * corners[corners.size() / 2].own();
  const double q = reachable(corners, goal, most_moved * mass);
  const auto arm = [&](std::size_t i) -> geom::Vec3 { return star.nodes[i] - star.nodes[centre]; };
  geom::Vec3 off = geom::Vec3::Zero(); // kg m, sum m r
  geom::Mat3 moments = geom::Mat3::Zero();
  for (std::size_t i = 0; i < centre; ++i) {
    star.mass[i] = std::max(star.mass[i], q * sums[i]);
    off += star.mass[i] * arm(i);
    moments += star.mass[i] * arm(i) * arm(i).transpose();
  }
  const geom::Vec3 tilt = moments.inverse() * off;
  star.mass[centre] = mass;
  for (std::size_t i = 0; i < centre; ++i) {
    star.mass[i] *= 1 - tilt.dot(arm(i));
    star.mass[centre] -= star.mass[i];
  }
}

void raise_light_corners(Model& model, int block) {
  const Block& b = model.blocks[block];
  StarMasses star;
  star.nodes.assign(model.node_position.begin() + b.node_begin, model.node_position.begin() + b.node_end);
  star.mass.assign(model.node_mass.begin() + b.node_begin, model.node_mass.begin() + b.node_end);
  star.tets.assign(model.tets.begin() + b.tet_begin, model.tets.begin() + b.tet_end);
  for (geom::Tet& tet : star.tets)
    for (int& node : tet)
      node -= b.node_begin;
  raise_light_corners(model.bodies[b.body].material, star);
  std::copy(star.mass.begin(), star.mass.end(), model.node_mass.begin() + b.node_begin);
}

void raise_light_corners_of_regions(Model& model, const geom::TetMesh& mesh, const Block& block) {
  std::map<int, std::vector<int>> tets_of; // of the model, by region
  std::map<int, std::pair<int, int>> uses; // by node: region, tets; -1: of several regions
  for (int t = block.tet_begin; t < static_cast<int>(model.tets.size()); ++t) {
    const int region = mesh.region[t - block.tet_begin];
    tets_of[region].push_back(t);
    for (const int node : model.tets[t]) {
      auto& [of, tets] = uses.emplace(node, std::pair(region, 0)).first->second;
      of = of == region ? region : -1;
      ++tets;
    }
  }
  std::vector<double> change(model.node_mass.size(), 0); // kg
  for (const auto& [region, tets] : tets_of) {
    int centre = -1;
    for (const int node : model.tets[tets[0]])
      if (uses.at(node) == std::pair(region, static_cast<int>(tets.size())))
        centre = node;
    if (centre < 0 || tets.size() < 4)
      continue;
    std::map<int, int> place; // by node
    StarMasses star;
    std::vector<int> nodes;
    const auto local = [&](int node) {
      const auto [at, fresh] = place.emplace(node, static_cast<int>(nodes.size()));
      if (fresh) {
        nodes.push_back(node);
        star.nodes.push_back(model.node_position[node]);
      }
      return at->second;
    };
    for (const int t : tets)
      for (const int node : model.tets[t])
        if (node != centre)
          local(node);
    local(centre);
    star.mass.assign(nodes.size(), 0);
    for (const int t : tets) {
      geom::Tet tet = model.tets[t];
      for (int& node : tet) {
        node = local(node);
        star.mass[node] +=
            model.bodies[block.body].material.density * tet_volume(mesh, t - block.tet_begin) / 4;
      }
      star.tets.push_back(tet);
    }
    const std::vector<double> before = star.mass;
    raise_light_corners(model.bodies[block.body].material, star);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      change[nodes[i]] += star.mass[i] - before[i];
  }
  for (std::size_t i = 0; i < change.size(); ++i)
    model.node_mass[i] += change[i];
}

} // namespace cdem
