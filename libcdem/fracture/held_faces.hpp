// The faces of one chunk that may crack and are not freed yet, and how much of their strength they use.
#pragma once

#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/strength_watch.hpp"
#include "libcdem/fracture/stress_bounds.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <algorithm>

namespace cdem {

class StrengthWatch::ChunkFaces {
public:
  ChunkFaces(const StrengthWatch& watch, const Model& model, const MeshChunk& chunk)
      : watch_(watch), model_(model), chunk_(chunk), body_(model.bodies[model.blocks[chunk.block].body]),
        of_body_(rock_strength(body_.joint)) {}

  bool is_open(std::int64_t tet, int face) const {
    const MeshData& mesh = model_.mesh;
    const int beyond = watch_.neighbours_[4 * (tet - mesh.first_tet) + face];
    if (beyond < 0 || !body_.bonding.bonds(mesh.region[tet - mesh.first_tet], mesh.region[beyond / 4]))
      return false;
    for (const int corner : geom::tet_faces[face])
      if (mesh.freed[model_.tets[tet][corner] - mesh.first_node] == 0)
        return true;
    return false;
  }
  bool any_open(std::int64_t tet) const {
    bool any = false;
    for (int face = 0; face < 4; ++face)
      any = any || is_open(tet, face);
    return any;
  }
  std::int64_t beyond(std::int64_t tet, int face) const {
    return model_.mesh.first_tet + watch_.neighbours_[4 * (tet - model_.mesh.first_tet) + face] / 4;
  }

  // The larger utilisation of the mean stress of both tets, now and ahead (s), with what the springs of the face add to its
  // traction, Pa, and will have added by then.
  double utilisation(const State& state, std::int64_t tet, int face, double ahead,
                     const geom::Vec3& pull = geom::Vec3::Zero(),
                     const geom::Vec3& pull_rises = geom::Vec3::Zero()) const {
    const MeshData& mesh = model_.mesh;
    const std::int64_t other = beyond(tet, face), at = 4 * (tet - mesh.first_tet) + face;
    const RockStrength& rock = watch_.own_.empty() ? of_body_ : watch_.own_[static_cast<std::size_t>(at)];
    const FacePlane kind =
        watch_.plane_.empty() ? FacePlane::of_material : watch_.plane_[static_cast<std::size_t>(at)];
    const geom::Tet& nodes = model_.tets[tet];
    const auto place = [&](int k) { return place_of(model_, state, nodes[geom::tet_faces[face][k]]); };
    const geom::Vec3 normal = (place(1) - place(0)).cross(place(2) - place(0)).normalized();
    const geom::Mat3 now = 0.5 * (stress_of(state, tet) + stress_of(state, other));
    const geom::Mat3 rise = ahead * 0.5 * (rate_of(state, tet) + rate_of(state, other));
    const auto use = [&](const geom::Mat3& stress, const geom::Vec3& added) {
      return strength_utilisation(with_traction(stress, normal, stress * normal + added), rock, normal, kind);
    };
    return std::max(use(now, pull), use(now + rise, pull + pull_rises));
  }
  // The utilisation of a joint that is freed at some of its corners only. Its springs pull before its tets do: it counts as due
  // where it cracks, and where they pull enough.
  double half_freed(const State& state, std::int64_t batch, int lane, double ahead, double harmless) const {
    const MeshData& mesh = model_.mesh;
    if (!holds(state.faces[batch].stage[lane]))
      return 1;
    const FaceNodes nodes = face_nodes(mesh, chunk_, batch, lane);
    const double k = mesh.faces[batch].kn[lane] / 3,
                 area = mesh.faces[batch].area[lane]; // a third of the face
    geom::Vec3 pull = geom::Vec3::Zero(), rises = geom::Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      const int a = nodes.a[i], b = nodes.b[i];
      pull += k * (vec(state.displacement[b]) - vec(state.displacement[a]));
      rises += ahead * k * (vec(state.velocity[b]) - vec(state.velocity[a]));
    }
    if (!(most_of_traction * pull.norm() > (1 - due_at) * harmless * area))
      return 0;
    const FaceTets& tets = mesh.face_tets[batch * lanes + lane];
    for (int face = 0; face < 4; ++face)
      if (const int side = watch_.neighbours_[4 * (tets.tet_a - mesh.first_tet) + face];
          side >= 0 && side / 4 == tets.tet_b - mesh.first_tet)
        return utilisation(state, tets.tet_a, face, ahead, pull / area, rises / area);
    return 0;
  }
  geom::Mat3 stress_of(const State& state, std::int64_t tet) const {
    return matrix(mesh_stress(model_, state, static_cast<int>(tet)));
  }
  // Whether a face between the tet and one that is nearer to its strength may be beyond a bound, now or ahead (s). The bounds
  // are convex: if two stresses are below them, so is their mean.
  bool may_reach(const std::vector<UtilisationBound>& bounds, const State& state, std::int64_t tet,
                 double ahead) const {
    const geom::Mat3 now = stress_of(state, tet);
    return may_use(bounds, now) || may_use(bounds, now + ahead * rate_of(state, tet));
  }
  // Pa/s, without the turning.
  geom::Mat3 rate_of(const State& state, std::int64_t tet) const {
    return matrix(elastic_stress(body_.material, velocity_gradient(model_, state, static_cast<int>(tet))));
  }

private:
  const StrengthWatch& watch_;
  const Model& model_;
  const MeshChunk& chunk_;
  const Body& body_;
  RockStrength of_body_;
};

template <class Visit>
void StrengthWatch::each_half_freed(const MeshChunk& chunk, const Visit& visit) const {
  for (std::int64_t batch = chunk.face_batches.begin; batch < chunk.face_batches.end; ++batch)
    for (unsigned bits = half_freed_[batch]; bits != 0; bits &= bits - 1)
      visit(batch, __builtin_ctz(bits));
}

} // namespace cdem
