#include "libcdem/model/build/star_inertia.hpp"

#include "libcdem/model/build/second_moments.hpp"

namespace cdem {

void match_star_inertia(Model& model, int block) {
  const Block& b = model.blocks[block];
  const int centroid = b.node_end - 1; // star_mesh puts it last
  const auto arm = [&](int node) -> geom::Vec3 {
    return model.node_position[node] - model.node_position[centroid];
  };
  double nodal = 0; // kg m2
  for (int node = b.node_begin; node < centroid; ++node)
    nodal += model.node_mass[node] * arm(node).squaredNorm();
  const double scale = second_moments(model, block, arm).trace() / nodal;
  for (int node = b.node_begin; node < centroid; ++node) {
    model.node_mass[centroid] += (1 - scale) * model.node_mass[node];
    model.node_mass[node] *= scale;
  }
}

} // namespace cdem
