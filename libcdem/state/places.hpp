// Where nodes are and how fast, as vectors.
#pragma once

#include "libcdem/state/state.hpp"

namespace cdem {

CDEM_INLINE geom::Vec3 vec(const Node& n) {
  return {n.x, n.y, n.z};
}
inline Node node(const geom::Vec3& v) {
  return {v.x(), v.y(), v.z(), 0};
}

inline void add(Node& n, const geom::Vec3& v) {
  n.x += v.x();
  n.y += v.y();
  n.z += v.z();
}

inline geom::Vec3 place_of(const Model& model, const State& state, int node) { // m
  return model.node_position[node] + vec(state.displacement[node]);
}
inline geom::Vec3 velocity_of(const State& state, int node) { // m/s
  return vec(state.velocity[node]);
}

} // namespace cdem
