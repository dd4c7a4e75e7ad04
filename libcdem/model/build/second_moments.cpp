#include "libcdem/model/build/second_moments.hpp"

namespace cdem {

geom::Mat3 second_moments(const Model& model, int block, const std::function<geom::Vec3(int)>& arm) {
  const Block& b = model.blocks[block];
  const double density = model.bodies[b.body].material.density;
  geom::Mat3 moments = geom::Mat3::Zero();
  for (int tet = b.tet_begin; tet < b.tet_end; ++tet) {
    const auto edge = [&](int corner) -> geom::Vec3 { // undeformed: the mass stays
      return model.node_position[model.tets[tet][corner]] - model.node_position[model.tets[tet][0]];
    };
    const double mass = density * edge(1).dot(edge(2).cross(edge(3))) / 6;
    geom::Vec3 sum = geom::Vec3::Zero();
    geom::Mat3 squares = geom::Mat3::Zero();
    for (const int node : model.tets[tet]) {
      const geom::Vec3 r = arm(node);
      sum += r;
      squares += r * r.transpose();
    }
    moments += mass / 20 * (squares + sum * sum.transpose());
  }
  return moments;
}

} // namespace cdem
