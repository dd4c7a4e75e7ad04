#include "libcdem/element/mesh_fields.hpp"

#include "libcdem/bond/cohesive_faces.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/state/places.hpp"

#include <map>

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

// J / 2 of face_jumps.hpp, summed over the freed faces of each tet of a mesh, m3/s; empty where there are none.
std::vector<geom::Mat3> velocity_jumps(const Model& model, const State& state,
                                       const std::vector<Node>& position) {
  std::vector<geom::Mat3> jumps(
      model.mesh.sides.empty() ? 0 : model.tets.size() - static_cast<std::size_t>(model.mesh.first_tet),
      geom::Mat3::Zero());
  each_side(model.mesh, [&](int tet, int face, const geom::Triangle& own, const geom::Triangle& beyond) {
    if (!holds(state.faces[face / lanes].stage[face % lanes]))
      return;
    geom::Vec3 jump = geom::Vec3::Zero();
    for (int i = 0; i < 3; ++i)
      jump += (vec(state.velocity[beyond[i]]) - vec(state.velocity[own[i]])) / 3;
    const geom::Vec3 x0 = vec(position[own[0]]);
    const geom::Vec3 area = 0.5 * (vec(position[own[1]]) - x0).cross(vec(position[own[2]]) - x0);
    jumps[tet - model.mesh.first_tet] += 0.5 * jump * area.transpose();
  });
  return jumps;
}

// A tet and what its strain depends on: sum of sym(u of the node (x) gradient), with the nodes beyond its freed faces.
struct Reach {
  double volume = 0;
  std::vector<std::pair<int, geom::Vec3>> gradients; // 1/m
  geom::Vec3& at(int node) {
    for (auto& [known, gradient] : gradients)
      if (known == node)
        return gradient;
    return gradients.emplace_back(node, geom::Vec3::Zero()).second;
  }
};

std::array<geom::Vec3, 4> undeformed(const Model& model, int tet) {
  std::array<geom::Vec3, 4> x;
  for (int k = 0; k < 4; ++k)
    x[k] = model.node_position[model.tets[tet][k]];
  return x;
}

// Where faces are freed: the row sums of the tets with all that they reach to, in place of those of the tets alone where
// they are larger. As faces crack the rows go from these to those.
void raise_freed_rows(const Model& model, const TetsOfNodes& of, std::vector<double>& sums) {
  std::map<int, Reach> reaches; // by tet
  each_side(model.mesh, [&](int tet, int, const geom::Triangle& own, const geom::Triangle& beyond) {
    Reach& reach = reaches[tet];
    const std::array<geom::Vec3, 4> x = undeformed(model, tet);
    if (reach.gradients.empty()) {
      const TetGradients shape = tet_gradients(x);
      reach.volume = shape.volume;
      for (int k = 0; k < 4; ++k)
        reach.at(model.tets[tet][k]) += shape.gradient[k];
    }
    const geom::Vec3 &x0 = model.node_position[own[0]], &x1 = model.node_position[own[1]],
                     &x2 = model.node_position[own[2]];
    const geom::Vec3 part = (x1 - x0).cross(x2 - x0) / (12 * reach.volume); // A n / 6V
    for (int i = 0; i < 3; ++i) {
      reach.at(own[i]) -= part;
      reach.at(beyond[i]) += part;
    }
  });
  std::map<int, std::vector<int>> reaching; // tets by node
  for (const auto& [tet, reach] : reaches)
    for (const auto& [node, gradient] : reach.gradients)
      reaching[node].push_back(tet);
  Row row;
  for (const auto& [node, tets] : reaching) {
    row.clear();
    for (const int t : tets) {
      Reach& reach = reaches[t];
      const geom::Vec3 p = reach.at(node);
      for (const auto& [other, q] : reach.gradients)
        row.with(other) += stiffness_block(material_of(model, t), reach.volume, p, q);
    }
    const int i = node - model.mesh.first_node;
    for (std::int64_t j = of.begin[i]; j < of.begin[i + 1]; ++j) {
      const auto [t, a] = of.tets[j];
      if (reaches.count(t) > 0)
        continue;
      const TetGradients shape = tet_gradients(undeformed(model, t));
      for (int b = 0; b < 4; ++b)
        row.with(model.tets[t][b]) +=
            stiffness_block(material_of(model, t), shape.volume, shape.gradient[a], shape.gradient[b]);
    }
    sums[node] = std::max(sums[node], row.largest_sum());
  }
}

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
    stress = elastic_stress(material_of(model, tet), displacement_gradient(model, state.displacement, tet));
    for (int c = 0; c < 6; ++c)
      stress[c] += state.initial_stress[tet][c];
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
    energy += face_point_response(model, state, position, chunk, at).energy;
  });
  return energy;
}

FaceSpring face_point_response(const Model& model, const State& state, const std::vector<Node>& position,
                               const MeshChunk& chunk, const FaceSpringPlace& at) {
  const Body& body = model.bodies[model.blocks[chunk.block].body];
  const FaceBatch& batch = model.mesh.faces[at.batch];
  const FaceNodes nodes = face_nodes(model.mesh, chunk, at.batch, at.lane);
  if (body.bonding.is_cohesive()) {
    Joint room;
    const std::int64_t face = at.batch * lanes + at.lane;
    const Joint& joint = FaceJoints(model, state, chunk).of(face - chunk.face_batches.begin * lanes, room);
    return cohesive_spring(batch, at.lane, face_frame(nodes, position.data(), state.displacement.data()),
                           at.point, joint, state.faces[at.batch], state.cohesive[face]);
  }
  return face_spring(batch, nodes, at.point, at.lane, position.data(), state.displacement.data(),
                     face_law(model, chunk, at.batch, at.lane), state.faces[at.batch],
                     slip_of(state, at.batch, at.lane));
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
  const std::vector<geom::Mat3> jumps = velocity_jumps(model, state, position);
  for (int t = model.mesh.first_tet; t < static_cast<int>(model.tets.size()); ++t) {
    if (model.blocks[model.tet_block[t]].rigid >= 0)
      continue; // its stress stands still
    const TetGradients shape = shape_at(model, position, t);
    geom::Mat3 gradient = geom::Mat3::Zero();
    for (int k = 0; k < 4; ++k)
      gradient += vec(state.velocity[model.tets[t][k]]) * shape.gradient[k].transpose();
    if (!jumps.empty())
      gradient += jumps[t - model.mesh.first_tet] / shape.volume;
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
      const TetGradients shape = tet_gradients(undeformed(model, t));
      for (int b = 0; b < 4; ++b)
        row.with(model.tets[t][b]) +=
            stiffness_block(material_of(model, t), shape.volume, shape.gradient[a], shape.gradient[b]);
    }
    sums[static_cast<std::size_t>(model.mesh.first_node) + i] += row.largest_sum();
  }
  if (!model.mesh.sides.empty())
    raise_freed_rows(model, of, sums);
  each_face_spring(model.mesh, [&](const MeshChunk& chunk, const FaceSpringPlace& at) {
    const FaceBatch& batch = model.mesh.faces[at.batch];
    const int lane = at.lane;
    const Bonding& bonding = model.bodies[model.blocks[chunk.block].body].bonding;
    const double ratio = bonding.is_cohesive() ? 1 : bonding.shear_ratio;
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
