#include "libcdem/fracture/cut_motion.hpp"

#include "libcdem/state/places.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

struct Sums {
  double mass = 0;                          // kg
  geom::Vec3 centroid = geom::Vec3::Zero(); // m
  geom::Vec3 momentum = geom::Vec3::Zero(); // N s
  geom::Vec3 angular = geom::Vec3::Zero();  // N m s, about the centroid
  geom::Mat3 inertia = geom::Mat3::Zero();  // kg m2, about the centroid
  double energy = 0;                        // J
};

geom::Vec3 arm_end(const Model& model, const State& state, bool moves_far, int node) {
  return moves_far ? place_of(model, state, node) : model.node_position[node];
}

Sums sums_of(const Model& model, const State& state, bool moves_far, const std::vector<int>& nodes) {
  const geom::Vec3 near = arm_end(model, state, moves_far, nodes.front());
  Sums s;
  for (const int i : nodes) {
    s.mass += model.node_mass[i];
    s.centroid += model.node_mass[i] * (arm_end(model, state, moves_far, i) - near);
    s.momentum += model.node_mass[i] * vec(state.velocity[i]);
  }
  s.centroid = near + s.centroid / s.mass;
  for (const int i : nodes) {
    const double m = model.node_mass[i];
    const geom::Vec3 r = arm_end(model, state, moves_far, i) - s.centroid, v = vec(state.velocity[i]);
    s.angular += m * r.cross(v);
    s.inertia += m * (r.squaredNorm() * geom::Mat3::Identity() - r * r.transpose());
    s.energy += 0.5 * m * v.squaredNorm();
  }
  return s;
}

} // namespace

void keep_motion(const Model& old, const State& from, int block, const Model& now,
                 const std::vector<int>& nodes, State& state) {
  const Block& b = old.blocks[block];
  std::vector<int> old_nodes;
  for (int node = b.node_begin; node < b.node_end; ++node)
    old_nodes.push_back(node);
  const Sums before = sums_of(old, from, b.meshed, old_nodes), after = sums_of(now, state, b.meshed, nodes);
  const geom::Vec3 velocity = before.momentum / after.mass, drift = after.momentum / after.mass;
  // The new centroid may lie elsewhere by a little, if the block is strained: momentum about it.
  const geom::Vec3 angular = before.angular + (before.centroid - after.centroid).cross(before.momentum);
  const Eigen::LDLT<geom::Mat3> solver(after.inertia);
  geom::Vec3 spin =
      b.meshed ? geom::Vec3(solver.solve(angular)) : geom::Vec3(before.inertia.ldlt().solve(before.angular));
  const geom::Vec3 turn = solver.solve(after.angular);
  const auto rest_of = [&](int i) -> geom::Vec3 {
    return vec(state.velocity[i]) - drift - turn.cross(arm_end(now, state, b.meshed, i) - after.centroid);
  };
  double rest = 0; // J, of the deformation
  for (const int i : nodes)
    rest += 0.5 * now.node_mass[i] * rest_of(i).squaredNorm();
  const double flight = 0.5 * after.mass * velocity.squaredNorm(),
               rotation = 0.5 * spin.dot(after.inertia * spin), room = before.energy - flight;
  if (b.meshed && rotation > room && rotation > 0)
    spin *= std::sqrt(std::max(0.0, room) / rotation);
  const double kept = rest > 0 ? std::sqrt(std::clamp((room - rotation) / rest, 0.0, 1.0)) : 0;
  for (const int i : nodes)
    state.velocity[i] = node(geom::Vec3(
        velocity + spin.cross(arm_end(now, state, b.meshed, i) - after.centroid) + kept * rest_of(i)));
}

} // namespace cdem
