#include "libcdem/model/build/star_row_sums.hpp"

#include "libcdem/material/tet_stiffness.hpp"

#include <Eigen/Core>

#include <algorithm>

namespace cdem {

std::vector<double> star_row_sums(const Model& model, const Block& block) {
  const Elastic& material = model.bodies[block.body].material;
  const int n = block.node_end - block.node_begin;
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (int t = block.tet_begin; t < block.tet_end; ++t) {
    const geom::Tet& tet = model.tets[t];
    const auto& x = model.node_position;
    const TetGradients g = tet_gradients({x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]});
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        k.block<3, 3>(3 * (tet[a] - block.node_begin), 3 * (tet[b] - block.node_begin)) +=
            stiffness_block(material, g.volume, g.gradient[a], g.gradient[b]);
  }
  std::vector<double> sums(n, 0.0);
  for (int node = 0; node < n; ++node)
    for (int axis = 0; axis < 3; ++axis)
      sums[node] = std::max(sums[node], k.row(3 * node + axis).cwiseAbs().sum());
  return sums;
}

} // namespace cdem
