// Where the nodes of the field's cells are, and what acts on a mean of nodes: an equal part on each.
#pragma once

#include "libcdem/state/places.hpp"

namespace cdem::field {

// visit(node of the model, weight) for a node of a cell; the weights sum to 1.
template <class Visit>
void each_real_node(const Model& model, int node, const Visit& visit, double weight = 1) {
  const int n = static_cast<int>(model.node_position.size());
  if (node < n) {
    visit(node, weight);
    return;
  }
  const MeanNode& mean = model.field.means[node - n];
  for (int k = 0; k < mean.count; ++k) // of nodes on the surface, which are real
    visit(mean.of[k], weight / mean.count);
}

inline geom::Vec3 field_place(const Model& model, const State& state, int node) { // m
  geom::Vec3 x = geom::Vec3::Zero();
  each_real_node(model, node, [&](int real, double w) { x += w * place_of(model, state, real); });
  return x;
}
inline geom::Vec3 field_velocity(const Model& model, const State& state, int node) { // m/s
  geom::Vec3 v = geom::Vec3::Zero();
  each_real_node(model, node, [&](int real, double w) { v += w * velocity_of(state, real); });
  return v;
}

} // namespace cdem::field
