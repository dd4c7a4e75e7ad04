#include "libcdem/model/build/star_row_sums.hpp"

#include "libcdem/material/tet_stiffness.hpp"

#include <Eigen/Core>

#include <algorithm>

namespace cdem {

std::vector<double> star_row_sums(const Elastic& material, const std::vector<geom::Vec3>& nodes,
                                  const std::vector<geom::Tet>& tets) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (const geom::Tet& tet : tets) {
    const TetGradients g = tet_gradients({nodes[tet[0]], nodes[tet[1]], nodes[tet[2]], nodes[tet[3]]});
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        k.block<3, 3>(Eigen::Index{3} * tet[a], Eigen::Index{3} * tet[b]) +=
            stiffness_block(material, g.volume, g.gradient[a], g.gradient[b]);
  }
  std::vector<double> sums(nodes.size(), 0.0);
  for (Eigen::Index node = 0; node < n; ++node)
    for (int axis = 0; axis < 3; ++axis)
      sums[node] = std::max(sums[node], k.row(3 * node + axis).cwiseAbs().sum());
  return sums;
}

std::vector<double> star_row_sums(const Model& model, const Block& block) {
  std::vector<geom::Tet> tets(model.tets.begin() + block.tet_begin, model.tets.begin() + block.tet_end);
  for (geom::Tet& tet : tets)
    for (int& node : tet)
      node -= block.node_begin;
  return star_row_sums(
      model.bodies[block.body].material,
      {model.node_position.begin() + block.node_begin, model.node_position.begin() + block.node_end}, tets);
}

} // namespace cdem
