#include "libcdem/element/mesh_fields.hpp"

#include "libcdem/bond/freed_face.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/state/places.hpp"

namespace cdem {
namespace {

const Elastic& material_of(const Model& model, int tet) {
  return model.bodies[model.blocks[model.tet_block[tet]].body].material;
}

// Which tets touch or reach to a node: begin (n mesh nodes + 1) into tets, with its place among the nodes of each.
struct TetsOfNodes {
  std::vector<std::int64_t> begin;
  std::vector<std::pair<int, int>> tets;
};

// each(visit): visit(node, tet, place) for all of them, twice.
template <class Each>
TetsOfNodes tets_of_nodes(const Model& model, const Each& each) {
  const int first_node = model.mesh.first_node;
  TetsOfNodes of;
  of.begin.assign(model.node_position.size() - static_cast<std::size_t>(first_node) + 1, 0);
  each([&](int node, int, int) { ++of.begin[node - first_node + 1]; });
  for (std::size_t i = 1; i < of.begin.size(); ++i)
    of.begin[i] += of.begin[i - 1];
  of.tets.resize(of.begin.back());
  std::vector<std::int64_t> next(of.begin.begin(), of.begin.end() - 1);
  each([&](int node, int t, int place) { of.tets[next[node - first_node]++] = {t, place}; });
  return of;
}

// A node's row of the assembled stiffness: the blocks with each of its neighbours.
class Row {
public:
  explicit Row(std::size_t nodes) : place_(nodes, -1) {}
  void clear() {
    for (const int node : nodes_)
      place_[node] = -1;
    nodes_.clear();
    blocks_.clear();
  }
  geom::Mat3& with(int node) {
    if (place_[node] < 0) {
      place_[node] = static_cast<int>(nodes_.size());
      nodes_.push_back(node);
      blocks_.emplace_back(geom::Mat3::Zero());
    }
    return blocks_[place_[node]];
  }
  double largest_sum() const {
    geom::Vec3 sum = geom::Vec3::Zero();
    for (const geom::Mat3& block : blocks_)
      sum += block.cwiseAbs().rowwise().sum();
    return sum.maxCoeff();
  }

private:
  std::vector<int> place_; // by node of the model; -1: none yet
  std::vector<int> nodes_;
  std::vector<geom::Mat3> blocks_;
};

// The strain of a tet depends on this: sum of sym(u of the node (x) gradient), with the nodes beyond its freed faces.
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

// Undeformed, of tets of meshes; found when they are asked for.
class Shapes {
public:
  explicit Shapes(const Model& model)
      : model_(model), place_(model.tets.size() - static_cast<std::size_t>(model.mesh.first_tet), -1) {}
  const TetGradients& of(int tet) { // until the next call
    int& place = place_[tet - model_.mesh.first_tet];
    if (place < 0) {
      place = static_cast<int>(shapes_.size());
      std::array<geom::Vec3, 4> x;
      for (int k = 0; k < 4; ++k)
        x[k] = model_.node_position[model_.tets[tet][k]];
      shapes_.push_back(tet_gradients(x));
    }
    return shapes_[place];
  }

private:
  const Model& model_;
  std::vector<int> place_;
  std::vector<TetGradients> shapes_;
};

// Adds the blocks of one node of a tet with all that its strain depends on, gradients: 1/m, by node.
template <class Gradients>
void add_to_row(const Elastic& material, double volume, const geom::Vec3& own, const Gradients& gradients,
                Row& row) {
  const double lambda = material.lame_lambda(), shear = material.shear_modulus();
  for (const auto& [node, gradient] : gradients)
    row.with(node) += stiffness_block(lambda, shear, volume, own, gradient);
}

void add_to_row(const Model& model, const TetGradients& shape, int tet, int corner, Row& row) {
  const std::array<std::pair<int, const geom::Vec3&>, 4> gradients{{{model.tets[tet][0], shape.gradient[0]},
                                                                    {model.tets[tet][1], shape.gradient[1]},
                                                                    {model.tets[tet][2], shape.gradient[2]},
                                                                    {model.tets[tet][3], shape.gradient[3]}}};
  add_to_row(material_of(model, tet), shape.volume, shape.gradient[corner], gradients, row);
}

// Where faces are freed: the row sums of the tets with all that they reach to, in place of those of the tets alone where
// they are larger. As faces crack the rows go from these to those.
template <class Wanted>
void raise_freed_rows(const Model& model, const TetsOfNodes& of, const Wanted& wanted, Shapes& shapes,
                      Row& row, std::vector<double>& sums) {
  const int first_tet = model.mesh.first_tet;
  std::vector<int> place(model.mesh.tet_slot.size(),
                         -1); // per tet, into reaches; -1: no wanted node is reached
  std::vector<Reach> reaches;
  each_side(model.mesh, [&](int tet, int, const geom::Triangle&, const geom::Triangle& beyond) {
    if (place[tet - first_tet] >= 0 || !(std::any_of(beyond.begin(), beyond.end(), wanted) ||
                                         std::any_of(model.tets[tet].begin(), model.tets[tet].end(), wanted)))
      return;
    place[tet - first_tet] = static_cast<int>(reaches.size());
    const TetGradients& shape = shapes.of(tet);
    Reach& reach = reaches.emplace_back();
    reach.volume = shape.volume;
    for (int k = 0; k < 4; ++k)
      reach.at(model.tets[tet][k]) += shape.gradient[k];
  });
  each_side(model.mesh, [&](int tet, int, const geom::Triangle& own, const geom::Triangle& beyond) {
    if (place[tet - first_tet] < 0)
      return;
    Reach& reach = reaches[place[tet - first_tet]];
    const geom::Vec3 &x0 = model.node_position[own[0]], &x1 = model.node_position[own[1]],
                     &x2 = model.node_position[own[2]];
    const geom::Vec3 part = (x1 - x0).cross(x2 - x0) / (12 * reach.volume); // A n / 6V
    for (int i = 0; i < 3; ++i) {
      reach.at(own[i]) -= part;
      reach.at(beyond[i]) += part;
    }
  });
  const TetsOfNodes reaching = tets_of_nodes(model, [&](const auto& visit) {
    for (std::size_t t = 0; t < place.size(); ++t)
      for (std::size_t k = 0; place[t] >= 0 && k < reaches[place[t]].gradients.size(); ++k)
        if (const int node = reaches[place[t]].gradients[k].first; wanted(node))
          visit(node, first_tet + static_cast<int>(t), static_cast<int>(k));
  });
  for (std::size_t i = 0; i + 1 < reaching.begin.size(); ++i) {
    if (reaching.begin[i] == reaching.begin[i + 1])
      continue;
    row.clear();
    for (std::int64_t j = reaching.begin[i]; j < reaching.begin[i + 1]; ++j) {
      const auto [t, a] = reaching.tets[j];
      const Reach& reach = reaches[place[t - first_tet]];
      add_to_row(material_of(model, t), reach.volume, reach.gradients[a].second, reach.gradients, row);
    }
    for (std::int64_t j = of.begin[i]; j < of.begin[i + 1]; ++j)
      if (const auto [t, a] = of.tets[j]; place[t - first_tet] < 0)
        add_to_row(model, shapes.of(t), t, a, row);
    double& sum = sums[static_cast<std::size_t>(model.mesh.first_node) + i];
    sum = std::max(sum, row.largest_sum());
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

std::vector<Node> displacement_ago(const State& state, double lag) {
  std::vector<Node> u = state.displacement;
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i].x -= lag * state.velocity[i].x;
    u[i].y -= lag * state.velocity[i].y;
    u[i].z -= lag * state.velocity[i].z;
  }
  return u;
}

State moved_back(const State& state, double lag) {
  State moved = state;
  moved.displacement = displacement_ago(state, lag);
  return moved;
}

void add_mesh_row_sums(const Model& model, std::vector<double>& sums, const std::vector<char>& rows) {
  if (model.mesh.empty())
    return;
  const int first_tet = model.mesh.first_tet;
  const auto wanted = [&](int node) { return rows.empty() || rows[node] != 0; };
  Shapes shapes(model);
  std::vector<int> tets; // at wanted nodes
  for (int t = first_tet; t < static_cast<int>(model.tets.size()); ++t)
    if (std::any_of(model.tets[t].begin(), model.tets[t].end(), wanted))
      tets.push_back(t);
  const TetsOfNodes of = tets_of_nodes(model, [&](const auto& visit) {
    for (const int t : tets)
      for (int k = 0; k < 4; ++k)
        if (wanted(model.tets[t][k]))
          visit(model.tets[t][k], t, k);
  });
  Row row(model.node_position.size());
  for (std::size_t i = 0; i + 1 < of.begin.size(); ++i) {
    row.clear();
    for (std::int64_t j = of.begin[i]; j < of.begin[i + 1]; ++j)
      add_to_row(model, shapes.of(of.tets[j].first), of.tets[j].first, of.tets[j].second, row);
    sums[static_cast<std::size_t>(model.mesh.first_node) + i] += row.largest_sum();
  }
  if (!model.mesh.sides.empty())
    raise_freed_rows(model, of, wanted, shapes, row, sums);
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t face, int lane) {
    const FaceNodes nodes = face_nodes(model.mesh, chunk, face, lane);
    if (!std::any_of(nodes.a.begin(), nodes.a.end(), wanted) &&
        !std::any_of(nodes.b.begin(), nodes.b.end(), wanted))
      return;
    const Bonding& bonding = model.bodies[model.blocks[chunk.block].body].bonding;
    const double ratio = bonding.is_cohesive() ? 1 : bonding.shear_ratio;
    const geom::Vec3 &x0 = model.node_position[nodes.a[0]], &x1 = model.node_position[nodes.a[1]],
                     &x2 = model.node_position[nodes.a[2]];
    const geom::Vec3 n = (x1 - x0).cross(x2 - x0).normalized();
    const geom::Mat3 k =
        model.mesh.faces[face].kn[lane] * (ratio * geom::Mat3::Identity() + (1 - ratio) * n * n.transpose());
    const double sum = 2 * k.cwiseAbs().rowwise().sum().maxCoeff(); // weights of both sides sum to 2
    for (int point = 0; point < 3; ++point)
      for (int i = 0; i < 3; ++i) {
        const double weight = i == point ? 2.0 / 3 : 1.0 / 6;
        for (const int node : {nodes.a[i], nodes.b[i]})
          if (wanted(node))
            sums[node] += weight * sum;
      }
  });
}

} // namespace cdem
