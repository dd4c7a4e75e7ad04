#include "libcdem/element/mesh_fields.hpp"

#include "libcdem/bond/face_bonds.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/state/places.hpp"

namespace cdem {
namespace {

TetGradients shape_at(const Model& model, const std::vector<Node>& position, int tet) {
  std::array<geom::Vec3, 4> x;
  for (int k = 0; k < 4; ++k)
    x[k] = vec(position[model.tets[tet][k]]);
  return tet_gradients(x);
}

const Elastic& material_of(const Model& model, int tet) {
  return model.bodies[model.blocks[model.tet_block[tet]].body].material;
}

// Which tets touch a node: begin (n mesh nodes + 1) into tets, with the corner.
struct TetsOfNodes {
  std::vector<std::int64_t> begin;
  std::vector<std::pair<int, int>> tets;
};

TetsOfNodes tets_of_nodes(const Model& model) {
  const int first_node = model.mesh.first_node, first_tet = model.mesh.first_tet;
  TetsOfNodes of;
  of.begin.assign(model.node_position.size() - static_cast<std::size_t>(first_node) + 1, 0);
  const auto each = [&](const auto& visit) {
    for (int t = first_tet; t < static_cast<int>(model.tets.size()); ++t)
      for (int k = 0; k < 4; ++k)
        visit(model.tets[t][k] - first_node, t, k);
  };
  each([&](int node, int, int) { ++of.begin[node + 1]; });
  for (std::size_t i = 1; i < of.begin.size(); ++i)
    of.begin[i] += of.begin[i - 1];
  of.tets.resize(of.begin.back());
  std::vector<std::int64_t> next(of.begin.begin(), of.begin.end() - 1);
  each([&](int node, int t, int k) { of.tets[next[node]++] = {t, k}; });
  return of;
}

// A node's row of the assembled stiffness: the blocks with each of its neighbours.
class Row {
public:
  void clear() { used_ = 0; }
  geom::Mat3& with(int node) {
    for (std::size_t i = 0; i < used_; ++i)
      if (nodes_[i] == node)
        return blocks_[i];
    if (used_ == nodes_.size()) {
      nodes_.push_back(node);
      blocks_.emplace_back();
    }
    nodes_[used_] = node;
    blocks_[used_].setZero();
    return blocks_[used_++];
  }
  double largest_sum() const {
    geom::Vec3 sum = geom::Vec3::Zero();
    for (std::size_t i = 0; i < used_; ++i)
      sum += blocks_[i].cwiseAbs().rowwise().sum();
    return sum.maxCoeff();
  }

private:
  std::size_t used_ = 0;
  std::vector<int> nodes_;
  std::vector<geom::Mat3> blocks_;
};

} // namespace

std::vector<Node> present_places(const Model& model, const State& state) {
  std::vector<Node> x(model.node_position.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = {model.node_position[i].x() + state.displacement[i].x,
            model.node_position[i].y() + state.displacement[i].y,
            model.node_position[i].z() + state.displacement[i].z, 0};
  return x;
}

Stress tet_stress(const Model& model, const State& state, int tet) {
  Stress stress{};
  if (tet < model.mesh.first_tet || model.mesh.empty()) {
    const int block = model.tet_block[tet];
    stress = elastic_stress(material_of(model, tet), displacement_gradient(model, state.displacement, tet));
    for (int c = 0; c < 6; ++c)
      stress[c] += state.initial_stress[block][c];
    return stress;
  }
  stress = mesh_stress(model, state, tet);
  const int rigid = model.blocks[model.tet_block[tet]].rigid;
  return rigid < 0 ? stress : turned(rotation(state.rigid[rigid]), stress);
}

double mesh_elastic_energy(const Model& model, const State& state) {
  if (model.mesh.empty())
    return 0;
  const std::vector<Node> position = present_places(model, state);
  double energy = 0;
  for (int t = model.mesh.first_tet; t < static_cast<int>(model.tets.size()); ++t) {
    const Elastic& m = material_of(model, t);
    const geom::Mat3 s = matrix(tet_stress(model, state, t));
    const double trace = s.trace(), g = m.shear_modulus();
    // sigma : C^-1 : sigma = (sigma : sigma - nu / (1 + nu) tr(sigma)^2) / 2G
    const double work =
        (s.squaredNorm() - m.poissons_ratio / (1 + m.poissons_ratio) * trace * trace) / (2 * g);
    energy += 0.5 * work * shape_at(model, position, t).volume;
  }
  return energy;
}

double mesh_spring_energy(const Model& model, const State& state) {
  if (model.mesh.faces.empty())
    return 0;
  const std::vector<Node> position = present_places(model, state);
  double energy = 0;
  each_face_spring(model.mesh, [&](const MeshChunk& chunk, const FaceSpringPlace& at) {
    const Body& body = model.bodies[model.blocks[chunk.block].body];
    energy += face_spring(model.mesh.faces[at.batch], face_nodes(model.mesh, chunk, at.batch, at.lane),
                          at.point, at.lane, position.data(), state.displacement.data(), face_law(body),
                          state.faces[at.batch], slip_of(state, at.batch, at.lane))
                  .energy;
  });
  return energy;
}

State moved_back(const Model& model, const State& state, double lag) {
  State moved = state;
  for (std::size_t i = 0; i < state.velocity.size(); ++i) {
    moved.displacement[i].x -= lag * state.velocity[i].x;
    moved.displacement[i].y -= lag * state.velocity[i].y;
    moved.displacement[i].z -= lag * state.velocity[i].z;
  }
  if (model.mesh.empty() || lag == 0)
    return moved;
  const std::vector<Node> position = present_places(model, state);
  for (int t = model.mesh.first_tet; t < static_cast<int>(model.tets.size()); ++t) {
    if (model.blocks[model.tet_block[t]].rigid >= 0)
      continue; // its stress stands still
    const TetGradients shape = shape_at(model, position, t);
    geom::Mat3 gradient = geom::Mat3::Zero();
    for (int k = 0; k < 4; ++k)
      gradient += vec(state.velocity[model.tets[t][k]]) * shape.gradient[k].transpose();
    const Stress increment = elastic_stress(material_of(model, t), lag * gradient);
    const int slot = model.mesh.tet_slot[t - model.mesh.first_tet];
    for (int c = 0; c < 6; ++c)
      moved.stress[slot / lanes].component[c][slot % lanes] -= increment[c];
  }
  return moved;
}

void add_mesh_row_sums(const Model& model, std::vector<double>& sums) {
  if (model.mesh.empty())
    return;
  const TetsOfNodes of = tets_of_nodes(model);
  Row row;
  for (std::size_t i = 0; i + 1 < of.begin.size(); ++i) {
    row.clear();
    for (std::int64_t j = of.begin[i]; j < of.begin[i + 1]; ++j) {
      const auto [t, a] = of.tets[j];
      std::array<geom::Vec3, 4> x;
      for (int k = 0; k < 4; ++k)
        x[k] = model.node_position[model.tets[t][k]];
      const TetGradients shape = tet_gradients(x);
      const Elastic& material = material_of(model, t);
      const double lambda = material.lame_lambda(), shear = material.shear_modulus();
      for (int b = 0; b < 4; ++b) {
        const geom::Vec3 &p = shape.gradient[a], &q = shape.gradient[b];
        row.with(model.tets[t][b]) +=
            shape.volume * (lambda * p * q.transpose() + shear * (q * p.transpose()) +
                            shear * p.dot(q) * geom::Mat3::Identity());
      }
    }
    sums[static_cast<std::size_t>(model.mesh.first_node) + i] += row.largest_sum();
  }
  each_face_spring(model.mesh, [&](const MeshChunk& chunk, const FaceSpringPlace& at) {
    const FaceBatch& batch = model.mesh.faces[at.batch];
    const int lane = at.lane;
    const double ratio = model.bodies[model.blocks[chunk.block].body].bonding.shear_ratio;
    const FaceNodes nodes = face_nodes(model.mesh, chunk, at.batch, lane);
    const geom::Vec3 &x0 = model.node_position[nodes.a[0]], &x1 = model.node_position[nodes.a[1]],
                     &x2 = model.node_position[nodes.a[2]];
    const geom::Vec3 n = (x1 - x0).cross(x2 - x0).normalized();
    const geom::Mat3 k = batch.kn[lane] * (ratio * geom::Mat3::Identity() + (1 - ratio) * n * n.transpose());
    const double sum = 2 * k.cwiseAbs().rowwise().sum().maxCoeff(); // weights of both sides sum to 2
    for (int i = 0; i < 3; ++i) {
      const double weight = i == at.point ? 2.0 / 3 : 1.0 / 6;
      sums[nodes.a[i]] += weight * sum;
      sums[nodes.b[i]] += weight * sum;
    }
  });
}

} // namespace cdem
