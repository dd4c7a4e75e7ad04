// Strain and stress of tets and blocks, outside the step: for results, criteria and the stiffness bound.
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/model/build/star_row_sums.hpp"
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

geom::Mat3 velocity_gradient(const Model& model, const State& state, int tet) {
  const TetGradients g = geometry(model, tet);
  const geom::Tet& nodes = model.tets[tet];
  const geom::Vec3 u0 = vec(state.displacement[nodes[0]]), v0 = vec(state.velocity[nodes[0]]);
  geom::Mat3 f = geom::Mat3::Identity(), l = geom::Mat3::Zero();
  for (int k = 1; k < 4; ++k) {
    f += (vec(state.displacement[nodes[k]]) - u0) * g.gradient[k].transpose();
    l += (vec(state.velocity[nodes[k]]) - v0) * g.gradient[k].transpose();
  }
  return l * f.inverse();
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
  for (const Block& block : model.blocks)
    if (!block.meshed)
      std::copy_n(star_row_sums(model, block).begin(), block.node_end - block.node_begin,
                  sums.begin() + block.node_begin);
  return sums;
}

} // namespace cdem
