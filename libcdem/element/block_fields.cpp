// Strain and stress of tets and blocks, outside the step: for results, criteria and the stiffness bound.
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/state/places.hpp"

#include <Eigen/SVD>

namespace cdem {
namespace {

TetGradients geometry(const Model& model, int tet) {
  const geom::Tet& t = model.tets[tet];
  const auto& x = model.node_position;
  return tet_gradients({x[t[0]], x[t[1]], x[t[2]], x[t[3]]});
}

// Volume mean over a block of small strain. It is the common one, to the last bit, where all tets have the same.
Stress mean_initial_stress(const Model& model, const State& state, const Block& block) {
  const Stress& first = state.initial_stress[block.tet_begin];
  Stress sum{};
  double volume = 0;
  for (int tet = block.tet_begin; tet < block.tet_end; ++tet) {
    const double v = tet_volume(model, tet);
    volume += v;
    for (int c = 0; c < 6; ++c)
      sum[c] += v * (state.initial_stress[tet][c] - first[c]);
  }
  for (int c = 0; c < 6; ++c)
    sum[c] = first[c] + sum[c] / volume;
  return sum;
}

} // namespace

TetGradients tet_gradients(const std::array<geom::Vec3, 4>& x) {
  TetGradients g;
  const geom::Vec3 e1 = x[1] - x[0], e2 = x[2] - x[0], e3 = x[3] - x[0];
  const double six_volume = e1.dot(e2.cross(e3));
  g.volume = six_volume / 6;
  g.gradient[1] = e2.cross(e3) / six_volume;
  g.gradient[2] = e3.cross(e1) / six_volume;
  g.gradient[3] = e1.cross(e2) / six_volume;
  g.gradient[0] = -(g.gradient[1] + g.gradient[2] + g.gradient[3]);
  return g;
}

geom::Mat3 matrix(const Stress& s) {
  geom::Mat3 m;
  m << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return m;
}

Stress tensor(const geom::Mat3& m) {
  return {m(0, 0),
          m(1, 1),
          m(2, 2),
          0.5 * (m(0, 1) + m(1, 0)),
          0.5 * (m(1, 2) + m(2, 1)),
          0.5 * (m(0, 2) + m(2, 0))};
}

Stress turned(const geom::Mat3& rotation, const Stress& stress) {
  const geom::Mat3 s = rotation * matrix(stress) * rotation.transpose();
  return {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
}

double tet_volume(const Model& model, int tet) {
  return geometry(model, tet).volume;
}

geom::Mat3 displacement_gradient(const Model& model, const std::vector<Node>& displacement, int tet) {
  const TetGradients g = geometry(model, tet);
  const geom::Vec3 u0 = vec(displacement[model.tets[tet][0]]);
  geom::Mat3 h = geom::Mat3::Zero();
  for (int k = 1; k < 4; ++k)
    h += (vec(displacement[model.tets[tet][k]]) - u0) * g.gradient[k].transpose();
  return h;
}

Stress elastic_stress(const Elastic& material, const geom::Mat3& h) {
  return tensor(material.lame_lambda() * h.trace() * geom::Mat3::Identity() +
                material.shear_modulus() * (h + h.transpose()));
}

geom::Mat3 block_gradient(const Model& model, const std::vector<Node>& displacement, const Block& block) {
  geom::Mat3 sum = geom::Mat3::Zero();
  double volume = 0;
  for (int tet = block.tet_begin; tet < block.tet_end; ++tet) {
    const double v = tet_volume(model, tet);
    sum += v * displacement_gradient(model, displacement, tet);
    volume += v;
  }
  return sum / volume;
}

Stress block_stress(const Model& model, const State& state, int block) {
  const Block& b = model.blocks[block];
  if (b.meshed) {
    Stress sum{};
    for (int tet = b.tet_begin; tet < b.tet_end; ++tet) {
      const Stress stress = tet_stress(model, state, tet);
      const double part = tet_volume(model, tet) / b.mass.volume;
      for (int c = 0; c < 6; ++c)
        sum[c] += part * stress[c];
    }
    return sum;
  }
  // Linear elasticity: the mean stress is the stress of the mean gradient.
  Stress stress = elastic_stress(model.bodies[b.body].material, block_gradient(model, state.displacement, b));
  const Stress initial = mean_initial_stress(model, state, b);
  for (int c = 0; c < 6; ++c)
    stress[c] += initial[c];
  return stress;
}

geom::Mat3 rotation_in(const geom::Mat3& m) {
  const Eigen::JacobiSVD<geom::Mat3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

geom::Mat3 block_rotation(const Model& model, const State& state, int block) {
  if (!model.blocks[block].meshed)
    return geom::Mat3::Identity();
  return rotation_in(geom::Mat3::Identity() + block_gradient(model, state.displacement, model.blocks[block]));
}

void add_stress_forces(const Model& model, int tet, const Stress& stress, std::vector<Node>& force) {
  const geom::Mat3 sigma = matrix(stress);
  const TetGradients g = geometry(model, tet);
  for (int k = 0; k < 4; ++k) {
    const geom::Vec3 f = -g.volume * (sigma * g.gradient[k]);
    Node& node = force[model.tets[tet][k]];
    node.x += f.x();
    node.y += f.y();
    node.z += f.z();
  }
}

std::vector<double> stiffness_row_sums(const Model& model) {
  std::vector<double> sums(model.node_position.size(), 0.0);
  Eigen::MatrixXd k;
  for (const Block& block : model.blocks) {
    if (block.meshed)
      continue;
    const Elastic& material = model.bodies[block.body].material;
    const double lambda = material.lame_lambda(), shear = material.shear_modulus();
    const int n = block.node_end - block.node_begin;
    k.setZero(3 * n, 3 * n);
    for (int tet = block.tet_begin; tet < block.tet_end; ++tet) {
      const TetGradients g = geometry(model, tet);
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) {
          const geom::Vec3 &p = g.gradient[a], &q = g.gradient[b];
          const int row = 3 * (model.tets[tet][a] - block.node_begin);
          const int column = 3 * (model.tets[tet][b] - block.node_begin);
          k.block<3, 3>(row, column) += g.volume * (lambda * p * q.transpose() + shear * (q * p.transpose()) +
                                                    shear * p.dot(q) * geom::Mat3::Identity());
        }
    }
    for (int node = 0; node < n; ++node)
      for (int axis = 0; axis < 3; ++axis)
        sums[block.node_begin + node] =
            std::max(sums[block.node_begin + node], k.row(3 * node + axis).cwiseAbs().sum());
  }
  return sums;
}

} // namespace cdem
