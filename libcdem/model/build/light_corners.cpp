#include "libcdem/model/build/light_corners.hpp"

#include "libcdem/model/build/star_row_sums.hpp"

#include <Eigen/LU>

#include <algorithm>

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

void raise_light_corners(Model& model, int block) {
  const Block& b = model.blocks[block];
  const std::vector<double> sums = star_row_sums(model, b);
  std::vector<Corner> corners;
  for (int node = b.node_begin; node < b.centroid_node(); ++node)
    corners.push_back({sums[node - b.node_begin], model.node_mass[node]});
  std::sort(corners.begin(), corners.end(),
            [](const Corner& l, const Corner& r) { return l.own() < r.own(); });
  const double goal = part_of_median * part_of_median * corners[corners.size() / 2].own();
  const double mass = model.bodies[b.body].material.density * b.mass.volume;
  const double q = reachable(corners, goal, most_moved * mass);
  const auto arm = [&](int node) -> geom::Vec3 { return model.node_position[node] - b.mass.centroid; };
  geom::Vec3 off = geom::Vec3::Zero(); // kg m, sum m r
  geom::Mat3 moments = geom::Mat3::Zero();
  for (int node = b.node_begin; node < b.centroid_node(); ++node) {
    model.node_mass[node] = std::max(model.node_mass[node], q * sums[node - b.node_begin]);
    off += model.node_mass[node] * arm(node);
    moments += model.node_mass[node] * arm(node) * arm(node).transpose();
  }
  const geom::Vec3 tilt = moments.inverse() * off;
  double& centroid = model.node_mass[b.centroid_node()];
  centroid = mass;
  for (int node = b.node_begin; node < b.centroid_node(); ++node) {
    model.node_mass[node] *= 1 - tilt.dot(arm(node));
    centroid -= model.node_mass[node];
  }
}

} // namespace cdem
