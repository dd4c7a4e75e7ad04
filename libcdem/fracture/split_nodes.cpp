#include "libcdem/fracture/split_nodes.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/model/build/freed_meshes.hpp"
#include "libcdem/state/carry.hpp"
#include "libcdem/state/places.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <map>

namespace cdem {
namespace {

// Tets keep their corners, so they tell which node each was: one of those that have been joined.
std::vector<int> old_nodes(const Model& old, const Model& now) {
  std::vector<int> was(now.node_position.size());
  for (int node = 0; node < old.mesh.first_node; ++node)
    was[node] = node;
  for (auto t = static_cast<std::size_t>(old.mesh.first_tet); t < old.tets.size(); ++t)
    for (int k = 0; k < 4; ++k)
      was[now.tets[t][k]] = old.tets[t][k];
  return was;
}

// Faces stand by their first tets in both models. Returns the new numbers of the old ones, -1: joined.
std::vector<std::int64_t> map_faces(const Model& old, const Model& now, TopologyMap& map) {
  std::vector<std::int64_t>& was = map.face.emplace(now.mesh.face_tets.size(), -1);
  std::vector<std::int64_t> is(old.mesh.face_tets.size(), -1);
  std::size_t next = 0; // of the old ones, the first whose first tet is not a lower one
  const auto first_tet = [&](std::size_t face) { return old.mesh.face_tets[face].tet_a; };
  each_face(now.mesh, [&](const MeshChunk&, std::int64_t batch, int lane) {
    const std::int64_t face = batch * lanes + lane;
    const FaceTets& tets = now.mesh.face_tets[face];
    while (next < is.size() && first_tet(next) < tets.tet_a) // an empty lane has -1
      ++next;
    for (std::size_t f = next; f < is.size() && first_tet(f) == tets.tet_a; ++f)
      if (old.mesh.face_tets[f].tet_b == tets.tet_b) {
        was[face] = static_cast<std::int64_t>(f);
        is[f] = face;
      }
  });
  return is;
}

// Outer triangles keep their numbers within their block; the sides of freed faces follow them. new_face: by the old numbers.
void map_triangles(const Model& old, const Model& now, const std::vector<std::int64_t>& new_face,
                   TopologyMap& map) {
  const ContactSurface &was = old.surface, &is = now.surface;
  std::vector<int>& new_triangle = map.new_triangle.emplace();
  std::vector<std::array<int, 2>> inner(now.mesh.face_tets.size(), {-1, -1}); // of both sides
  const auto side_of = [](const Model& model, const ContactTriangle& triangle) {
    return triangle.tet == model.mesh.face_tets[triangle.face].tet_a ? 0 : 1;
  };
  for (int t = 0; t < static_cast<int>(is.triangles.size()); ++t)
    if (is.triangles[t].face >= 0)
      inner[is.triangles[t].face][side_of(now, is.triangles[t])] = t;
  for (int t = 0; t < static_cast<int>(was.triangles.size()); ++t) {
    const ContactTriangle& triangle = was.triangles[t];
    if (triangle.face < 0)
      new_triangle.push_back(t - was.block_begin[triangle.block] + is.block_begin[triangle.block]);
    else if (const std::int64_t face = new_face[triangle.face]; face >= 0)
      new_triangle.push_back(inner[face][side_of(old, triangle)]);
    else
      new_triangle.push_back(-1); // between joined nodes
  }
}

// Goes on from map.divided.
Freed carry_over(const Model& old, State&& state, FreedModel&& now, TopologyMap& map) {
  Freed freed{std::move(now.model), std::move(state), {}, {}, std::move(now.tets)};
  if (!map.node)
    map.node = old_nodes(old, freed.model);
  map_triangles(old, freed.model, map_faces(old, freed.model, map), map);
  map.fragments_of_nodes = [](const Model& m, const State& s) { return fragments_of_nodes(m, s); };
  carry(old, freed.model, map, freed.state);
  freed.old_node = std::move(*map.node);
  freed.anew.resize(freed.old_node.size(), 0);
  return freed;
}

} // namespace

Freed split_nodes(const Model& model, State state, const std::vector<char>& nodes) {
  FreedModel now = with_freed_nodes(model, nodes);
  TopologyMap map;
  const std::vector<int>& was = map.node.emplace(old_nodes(model, now.model));
  for (int node = 0; node < static_cast<int>(was.size()); ++node)
    map.divided.push_back({was[node], node, now.model.node_mass[node] / model.node_mass[was[node]]});
  Freed freed = carry_over(model, std::move(state), std::move(now), map);
  const auto first = static_cast<std::size_t>(model.mesh.first_node);
  for (std::size_t i = first; i < freed.anew.size(); ++i)
    freed.anew[i] =
        static_cast<char>(freed.model.mesh.freed[i - first] != 0 &&
                          model.mesh.freed[static_cast<std::size_t>(freed.old_node[i]) - first] == 0);
  return freed;
}

std::vector<Node> bring_together(const Model& model, State& state, const std::vector<char>& nodes,
                                 double strain_step) {
  const MeshData& mesh = model.mesh;
  const std::vector<double>& masses = moving_mass(model, state);
  struct Mean {
    double mass = 0;
    Node displacement{}, velocity{}; // times the mass
  };
  std::map<int, Mean> means; // by the node that the copies are copies of
  const auto add = [](double part, const Node& from, Node& to) {
    to.x += part * from.x;
    to.y += part * from.y;
    to.z += part * from.z;
  };
  const auto each = [&](const auto& visit) {
    for (int node = mesh.first_node; node < static_cast<int>(nodes.size()); ++node)
      if (nodes[node] != 0)
        visit(node, means[mesh.original[node - mesh.first_node]]);
  };
  each([&](int node, Mean& mean) {
    mean.mass += masses[node];
    add(masses[node], state.displacement[node], mean.displacement);
    add(masses[node], state.velocity[node], mean.velocity);
  });
  std::vector<Node> moved(nodes.size());
  each([&](int node, const Mean& mean) {
    Node together{}, velocity{};
    add(1 / mean.mass, mean.displacement, together);
    add(1 / mean.mass, mean.velocity, velocity);
    moved[node] = together;
    add(-1, state.displacement[node], moved[node]);
    add(strain_step, state.velocity[node], moved[node]);
    add(-strain_step, velocity, moved[node]);
    state.displacement[node] = together;
    state.velocity[node] = velocity;
  });
  return moved;
}

Freed join_nodes(const Model& model, State state, const std::vector<char>& nodes) {
  FreedModel joined = with_freed_nodes(model, {}, nodes);
  TopologyMap map;
  std::vector<int> now(model.node_position.size());
  for (int node = 0; node < model.mesh.first_node; ++node)
    now[node] = node;
  for (auto t = static_cast<std::size_t>(model.mesh.first_tet); t < model.tets.size(); ++t)
    for (int k = 0; k < 4; ++k)
      now[model.tets[t][k]] = joined.model.tets[t][k];
  for (int node = 0; node < static_cast<int>(now.size()); ++node)
    map.divided.push_back({node, now[node], 1});
  return carry_over(model, std::move(state), std::move(joined), map);
}

void preload_faces(const Model& model, State& state, const std::vector<Node>& net_force,
                   const std::vector<char>& nodes) {
  // Copies and the faces between them, by the node they are copies of.
  struct Between {
    int a, b;
    std::int64_t face;
    int corner;
  };
  struct Star {
    std::vector<int> copies;
    std::vector<Between> faces;
  };
  std::map<int, Star> stars;
  const MeshData& mesh = model.mesh;
  const std::vector<double>& masses = moving_mass(model, state);
  for (int node = mesh.first_node; node < static_cast<int>(nodes.size()); ++node)
    if (nodes[node] != 0)
      stars[mesh.original[node - mesh.first_node]].copies.push_back(node);
  each_face(mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    const std::int64_t face = batch * lanes + lane;
    if (state.cohesive.empty() || !holds(state.faces[batch].stage[lane]))
      return;
    const FaceNodes at = face_nodes(mesh, chunk, batch, lane);
    for (int corner = 0; corner < 3; ++corner)
      if (nodes[at.a[corner]] != 0 && at.a[corner] != at.b[corner])
        stars[mesh.original[at.a[corner] - mesh.first_node]].faces.push_back(
            {at.a[corner], at.b[corner], face, corner});
  });
  for (const auto& entry : stars) {
    const Star& star = entry.second;
    const auto n = static_cast<Eigen::Index>(star.copies.size());
    if (n < 2)
      continue;
    const auto place = [&](int node) {
      return std::lower_bound(star.copies.begin(), star.copies.end(), node) - star.copies.begin();
    };
    geom::Vec3 total = geom::Vec3::Zero();
    double mass = 0;
    for (const int node : star.copies) {
      total += vec(net_force[node]);
      mass += masses[node];
    }
    Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(n, n);
    for (const Between& f : star.faces) {
      const auto a = place(f.a), b = place(f.b);
      laplacian(a, a) += 1;
      laplacian(b, b) += 1;
      laplacian(a, b) -= 1;
      laplacian(b, a) -= 1;
    }
    Eigen::MatrixXd missing(n, 3); // N, of each copy to what its share of the mass asks for
    for (Eigen::Index i = 0; i < n; ++i) {
      const int node = star.copies[i];
      missing.row(i) = (total * (masses[node] / mass) - vec(net_force[node])).transpose();
    }
    const Eigen::MatrixXd potential = laplacian.completeOrthogonalDecomposition().solve(missing);
    for (const Between& f : star.faces) {
      state.faces[f.face / lanes].preloaded[f.face % lanes] = 1;
      auto& q = state.cohesive[f.face].preload[f.corner];
      for (int axis = 0; axis < 3; ++axis)
        q[axis] += potential(place(f.a), axis) - potential(place(f.b), axis);
    }
  }
}

} // namespace cdem
