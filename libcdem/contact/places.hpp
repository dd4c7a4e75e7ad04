// Where corners and edges of the contact surface are.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

inline geom::Vec3 place_of(const Model& model, const State& state, int node) {
  const Node& u = state.displacement[node];
  return model.node_position[node] + geom::Vec3(u.x, u.y, u.z);
}
inline geom::Vec3 velocity_of(const State& state, int node) {
  const Node& v = state.velocity[node];
  return {v.x, v.y, v.z};
}

using Corners = std::array<geom::Vec3, 3>;

inline Corners corners_of(const Model& model, const State& state, const geom::Triangle& nodes) {
  return {place_of(model, state, nodes[0]), place_of(model, state, nodes[1]),
          place_of(model, state, nodes[2])};
}
inline geom::Vec3 unit_normal(const Corners& x) {
  return (x[1] - x[0]).cross(x[2] - x[0]).normalized();
}
inline geom::Vec3 weighted(const Corners& x, const geom::Vec3& w) {
  return w[0] * x[0] + w[1] * x[1] + w[2] * x[2];
}

inline geom::Box box_of(const Corners& x, double around) {
  geom::Box box;
  for (const geom::Vec3& corner : x)
    box.extend(corner);
  box.min.array() -= around;
  box.max.array() += around;
  return box;
}

} // namespace cdem
