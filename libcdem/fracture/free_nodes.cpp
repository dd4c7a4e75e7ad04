#include "libcdem/fracture/free_nodes.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/own_rocks.hpp"
#include "libcdem/model/build/face_strength.hpp"
#include "libcdem/model/build/freed_meshes.hpp"
#include "libcdem/parallel/simd.hpp"
#include "libcdem/ranks/shared_state.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <map>

namespace cdem {
namespace {

bool has_cohesive_bodies(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const Body& body) { return body.bonding.is_cohesive(); });
}

// Faces of one chunk that may part and use more of their strength than freed_at.
struct NearStrength {
  double most = 0;
  std::vector<int> nodes;
};

// Whether some of eight tets may use so much of their strength.
CDEM_INLINE void any_beyond_kernel(const StressBatch& stress, const UseBound& bound, bool& any) {
  simd::Oct s[6];
  for (int c = 0; c < 6; ++c)
    s[c] = simd::load(stress.component[c]);
  const simd::Oct beyond = bound.beyond(s);
  any = false;
  for (int lane = 0; lane < lanes; ++lane)
    any = any || beyond[lane] > 0;
}

bool may_use(const std::vector<UseBound>& bounds, const geom::Mat3& s) {
  const double components[6] = {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
  return std::any_of(bounds.begin(), bounds.end(),
                     [&](const UseBound& bound) { return bound.beyond(components) > 0; });
}

class Carrier {
public:
  Carrier(const Model& old, const State& from, Freed& to) : old_(old), from_(from), to_(to) {}

  void operator()() {
    to_.state = initial_state(to_.model);
    State& s = to_.state;
    s.time = from_.time;
    s.step = from_.step;
    s.velocity_lag = from_.velocity_lag;
    s.spent = from_.spent;
    s.crack_energy = from_.crack_energy;
    s.bond_offset = from_.bond_offset;
    s.bond_mode = from_.bond_mode;
    s.bond_damage = from_.bond_damage;
    s.bond_slip = from_.bond_slip;
    s.joint_history = from_.joint_history;
    s.slid_before = from_.slid_before;
    s.water_pressure = from_.water_pressure;
    s.released = from_.released;
    s.initial_stress = from_.initial_stress;
    s.stress = from_.stress; // tets keep their places
    s.viscous_stress = from_.viscous_stress;
    s.face_slip = from_.face_slip;
    s.rigid = from_.rigid;
    s.column_displacement = from_.column_displacement;
    s.column_velocity = from_.column_velocity;
    s.bolts = from_.bolts;
    carry_nodes();
    carry_faces();
    carry_contacts();
  }

private:
  void carry_nodes() {
    std::vector<int>& before = to_.old_node;
    before.resize(to_.model.node_position.size());
    const int first = old_.mesh.first_node;
    for (int node = 0; node < first; ++node)
      before[node] = node;
    for (std::size_t t = static_cast<std::size_t>(old_.mesh.first_tet); t < old_.tets.size(); ++t)
      for (int k = 0; k < 4; ++k)
        before[to_.model.tets[t][k]] = old_.tets[t][k];
    const auto carry = [&](const auto& from, auto& to) {
      if (from.empty())
        return;
      to.resize(before.size());
      for (std::size_t i = 0; i < before.size(); ++i)
        to[i] = from[before[i]];
    };
    carry(from_.displacement, to_.state.displacement);
    carry(from_.velocity, to_.state.velocity);
    carry(from_.displacement_zero, to_.state.displacement_zero);
    carry(from_.support_force, to_.state.support_force);
    for (std::size_t i = 0; i < to_.state.support_force.size(); ++i) { // shared by the copies of a node
      const double share = to_.model.node_mass[i] / old_.node_mass[before[i]];
      Node& force = to_.state.support_force[i];
      force = {share * force.x, share * force.y, share * force.z, 0};
    }
    carry(from_.rigid_offset, to_.state.rigid_offset);
    carry(from_.escaped, to_.state.escaped);
  }

  using Tets = std::pair<int, int>;
  static Tets tets_at(const MeshData& mesh, std::int64_t face) {
    return {mesh.face_tets[face].tet_a, mesh.face_tets[face].tet_b};
  }

  void carry_faces() {
    std::map<Tets, std::int64_t> old_face;
    each_face(old_.mesh, [&](const MeshChunk&, std::int64_t batch, int lane) {
      old_face[tets_at(old_.mesh, batch * lanes + lane)] = batch * lanes + lane;
    });
    each_face(to_.model.mesh, [&](const MeshChunk&, std::int64_t batch, int lane) {
      const std::int64_t now = batch * lanes + lane;
      const auto found = old_face.find(tets_at(to_.model.mesh, now));
      if (found == old_face.end())
        return;
      const std::int64_t was = found->second;
      const FaceStateBatch& from = from_.faces[was / lanes];
      FaceStateBatch& to = to_.state.faces[batch];
      for (int point = 0; point < 3; ++point)
        to.mode[point][lane] = from.mode[point][was % lanes];
      to.handed_over[lane] = from.handed_over[was % lanes];
      to.stage[lane] = from.stage[was % lanes];
      to.preloaded[lane] = from.preloaded[was % lanes];
      if (lane == was % lanes)
        to.slip = from.slip; // of faces with springs, which keep their batches
      to_.state.cohesive[now] = from_.cohesive[was];
      if (!from_.rate_factor.empty())
        to_.state.rate_factor[now] = from_.rate_factor[was];
    });
  }

  // Outer triangles keep their numbers within their block; the sides of freed faces follow them.
  void carry_contacts() {
    if (from_.contacts.empty())
      return;
    const ContactSurface &was = old_.surface, &now = to_.model.surface;
    std::map<std::pair<Tets, int>, int> inner; // of which side
    for (int t = 0; t < static_cast<int>(now.triangles.size()); ++t)
      if (now.triangles[t].face >= 0)
        inner[{tets_at(to_.model.mesh, now.triangles[t].face), now.triangles[t].tet}] = t;
    const auto triangle_now = [&](int t) {
      const ContactTriangle& triangle = was.triangles[t];
      if (triangle.face < 0)
        return t - was.block_begin[triangle.block] + now.block_begin[triangle.block];
      return inner.at({tets_at(old_.mesh, triangle.face), triangle.tet});
    };
    const std::vector<int> pieces = fragments_of_nodes(to_.model, to_.state);
    for (Contact c : from_.contacts) {
      const bool edge = c.kind == Contact::edge;
      const auto [source, target] = triangles_of(c);
      c.source =
          static_cast<std::uint32_t>(3 * triangle_now(source) + static_cast<int>(c.source) % 3) & 0x7fffffffu;
      c.target = edge ? 3 * triangle_now(target) + c.target % 3 : triangle_now(target);
      if (edge) {
        c.beside = triangle_now(c.beside);
        c.fragment = triangle_now(c.fragment);
      } else {
        c.fragment = pieces[now.triangles[c.target].nodes[0]];
      }
      to_.state.contacts.push_back(c);
    }
    std::sort(to_.state.contacts.begin(), to_.state.contacts.end(),
              [](const Contact& a, const Contact& b) { return key(a) < key(b); });
  }

  const Model& old_;
  const State& from_;
  Freed& to_;
};

} // namespace

FreeingWatch::FreeingWatch(const Model& model) {
  if (!has_cohesive_bodies(model))
    return;
  neighbours_ = mesh_neighbours(model);
  if (!has_own_strengths(model))
    return;
  const MeshData& mesh = model.mesh;
  own_.resize(neighbours_.size());
  bounds_.resize(mesh.chunks.size());
  for (std::size_t c = 0; c < mesh.chunks.size(); ++c) {
    const MeshChunk& chunk = mesh.chunks[c];
    const Body& body = model.bodies[model.blocks[chunk.block].body];
    if (!body.bonding.is_cohesive())
      continue;
    OwnRocks rocks(body);
    for (auto i = static_cast<std::size_t>(4 * (chunk.tets.begin - mesh.first_tet));
         i < static_cast<std::size_t>(4 * (chunk.tets.end - mesh.first_tet)); ++i) {
      if (neighbours_[i] < 0)
        continue;
      const int tet = static_cast<int>(i / 4), beyond = neighbours_[i] / 4;
      std::array<geom::Vec3, 3> corners;
      for (int k = 0; k < 3; ++k)
        corners[k] = model.node_position[model.tets[mesh.first_tet + tet][geom::tet_faces[i % 4][k]]];
      const FaceStrength face =
          face_strength(body, mesh.region[tet], mesh.region[beyond], corners,
                        tet_volume(model, mesh.first_tet + tet) + tet_volume(model, mesh.first_tet + beyond));
      own_[i] = rocks.of(face.joint, face.tensile_strength, face.cohesion);
      rocks.take(face.joint, own_[i]);
    }
    bounds_[c] = rocks.bounds(freed_at);
  }
}

std::optional<std::vector<char>> FreeingWatch::due(const Model& model, const State& state,
                                                   const SharedState* shared, int threads,
                                                   double from) const {
  const MeshData& mesh = model.mesh;
  std::vector<NearStrength> found(mesh.chunks.size());
  const Range own =
      shared ? shared->part().mesh_chunks() : Range{0, static_cast<std::int64_t>(mesh.chunks.size())};
  for_chunks(own, threads, [&](std::int64_t c) {
    const MeshChunk& chunk = mesh.chunks[c];
    const Body& body = model.bodies[model.blocks[chunk.block].body];
    if (!body.bonding.is_cohesive() || is_rigid(model, chunk))
      return;
    const RockStrength of_body = rock_strength(body.joint);
    const auto rock_of = [&](std::int64_t face) -> const RockStrength& { // of the mesh, as in neighbours_
      return own_.empty() ? of_body : own_[static_cast<std::size_t>(face)];
    };
    // The bounds are convex: if two stresses are below them, so is their mean.
    const std::vector<UseBound> bounds =
        own_.empty() ? use_bounds(of_body, freed_at) : bounds_[static_cast<std::size_t>(c)];
    const auto stress_of = [&](std::int64_t tet) {
      return matrix(mesh_stress(model, state, static_cast<int>(tet)));
    };
    for (std::int64_t t = chunk.tets.begin; t < chunk.tets.end; ++t) {
      const std::int64_t place = t - chunk.tets.begin;
      if (place % lanes == 0) {
        bool any = false;
        for (const UseBound& bound : bounds)
          if (!any)
            simd::best<any_beyond_kernel>(state.stress[chunk.batches.begin + place / lanes], bound, any);
        if (!any) {
          t += lanes - 1;
          continue;
        }
      }
      const geom::Mat3 s = stress_of(t);
      if (!may_use(bounds, s))
        continue;
      for (int face = 0; face < 4; ++face) {
        const int beyond = neighbours_[4 * (t - mesh.first_tet) + face];
        if (beyond < 0)
          continue;
        const std::int64_t other = mesh.first_tet + beyond / 4;
        if (!body.bonding.bonds(mesh.region[t - mesh.first_tet], mesh.region[other - mesh.first_tet]))
          continue;
        bool freed = true;
        for (const int corner : geom::tet_faces[face])
          freed = freed && mesh.freed[model.tets[t][corner] - mesh.first_node] != 0;
        if (freed)
          continue;
        const geom::Mat3 mean = 0.5 * (s + stress_of(other));
        const double use =
            may_use(bounds, mean) ? strength_use(mean, rock_of(4 * (t - mesh.first_tet) + face)) : 0;
        if (!(use >= freed_at))
          continue;
        found[c].most = std::max(found[c].most, use);
        for (const int corner : geom::tet_faces[face])
          found[c].nodes.push_back(model.tets[t][corner]);
      }
    }
  });
  double most = 0;
  for (const NearStrength& of : found)
    most = std::max(most, of.most);
  if (shared)
    ranks().largest(&most, 1);
  if (most < from)
    return std::nullopt;
  std::string near(model.node_position.size(), 0);
  for (const NearStrength& of : found)
    for (const int node : of.nodes)
      near[node] = 1;
  std::vector<char> nodes(near.size(), 0);
  for (const std::string& of_rank : shared ? ranks().gather(near) : std::vector<std::string>{near})
    for (std::size_t i = 0; i < nodes.size(); ++i)
      nodes[i] = nodes[i] || of_rank[i];
  return nodes;
}

Freed free_nodes(const Model& model, const State& state, const std::vector<char>& nodes) {
  Freed freed;
  freed.model = with_freed_nodes(model, nodes);
  Carrier(model, state, freed)();
  freed.anew.resize(freed.old_node.size(), 0);
  const auto first = static_cast<std::size_t>(model.mesh.first_node);
  for (std::size_t i = first; i < freed.anew.size(); ++i)
    freed.anew[i] =
        static_cast<char>(freed.model.mesh.freed[i - first] != 0 &&
                          model.mesh.freed[static_cast<std::size_t>(freed.old_node[i]) - first] == 0);
  return freed;
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
