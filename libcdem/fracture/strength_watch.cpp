#include "libcdem/fracture/strength_watch.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/own_rocks.hpp"
#include "libcdem/fracture/star_blocks.hpp"
#include "libcdem/fracture/stress_bounds.hpp"
#include "libcdem/model/build/face_strength.hpp"
#include "libcdem/model/build/freed_meshes.hpp"
#include "libcdem/model/known_of_model.hpp"
#include "libcdem/parallel/simd.hpp"
#include "libcdem/ranks/ranks.hpp"
#include "libcdem/state/places.hpp"
#include "libgeom/mesh/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace cdem {
namespace {

// What may be asked of a face that has resumed holding is at least this part of its strength (may_end, cohesive_faces.cpp).
constexpr double looked_at_from = 0.9;
// How long tets have been below `due_at` before nodes are joined, in times that a wave takes through the block; and the least
// part of the freed nodes of a block for which it is worth while.
constexpr double calm_for = 10, worth_joining = 0.1;

bool has_cohesive_bodies(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const Body& body) { return body.bonding.is_cohesive(); });
}

// A border of regions with an edge is none: no linear traction is in balance with its parts.
bool is_plane(const Model& model, const MeshChunk& chunk, const FacetFaces& facet) {
  constexpr double plane_cosine = 1 - 1e-6;
  geom::Vec3 along = geom::Vec3::Zero();
  double whole = 0;
  for (std::size_t i = 0; i < facet.faces.size(); ++i) {
    const int face = facet.faces[i];
    const geom::Triangle nodes =
        face_nodes(model.mesh, chunk, chunk.face_batches.begin + face / lanes, face % lanes).a;
    const auto& x = model.node_position;
    const geom::Vec3 area = (x[nodes[1]] - x[nodes[0]]).cross(x[nodes[2]] - x[nodes[0]]);
    along += (facet.first_is_a[i] != 0 ? 1 : -1) * area;
    whole += area.norm();
  }
  return along.norm() >= plane_cosine * whole;
}

} // namespace

void NearStrength::forget_pulls(const Model& model) {
  pull2.assign(model.mesh.faces.size() * lanes, std::numeric_limits<double>::infinity());
}

namespace {

KnownOfModel<StrengthWatch>& known_watches() {
  static KnownOfModel<StrengthWatch> known;
  return known;
}

} // namespace

StrengthWatch StrengthWatch::of(const Model& model) {
  if (!has_cohesive_bodies(model))
    return {};
  return *known_watches().of(model, [&] { return StrengthWatch(model); });
}

void StrengthWatch::keep(const Model& model) {
  if (!std::exchange(kept_, true))
    known_watches().of(model, [&] { return *this; });
}

StrengthWatch::StrengthWatch(const Model& model) {
  neighbours_ = mesh_neighbours(model);
  find_planes(model);
  const MeshData& mesh = model.mesh;
  const bool own = has_own_strengths(model);
  if (own)
    own_.resize(neighbours_.size());
  bounds_.resize(mesh.chunks.size());
  StarBlocks star_blocks = cdem::star_blocks(model);
  star_ = std::move(star_blocks.of_tet);
  MeshSeed seed; // of the block of the chunk
  std::optional<FaceStrengths> strengths;
  int seed_of = -1;
  for (std::size_t c = 0; c < mesh.chunks.size(); ++c) {
    const MeshChunk& chunk = mesh.chunks[c];
    const Body& body = model.bodies[model.blocks[chunk.block].body];
    if (!body.bonding.is_cohesive() || is_rigid(model, chunk))
      continue;
    if (own && seed_of != chunk.block) {
      seed_of = chunk.block;
      strengths.reset();
      seed = mesh_seed(model, seed_of);
      strengths.emplace(body, seed.mesh);
    }
    const int first = model.blocks[chunk.block].tet_begin - mesh.first_tet;
    OwnRocks rocks(body);
    if (!own)
      rocks.take(-1, rock_strength(body.joint));
    for (auto i = static_cast<std::size_t>(4 * (chunk.tets.begin - mesh.first_tet));
         own && i < static_cast<std::size_t>(4 * (chunk.tets.end - mesh.first_tet)); ++i) {
      if (neighbours_[i] < 0)
        continue;
      const int tet = static_cast<int>(i / 4), beyond = neighbours_[i] / 4;
      if (!body.bonding.bonds(mesh.region[tet], mesh.region[beyond]))
        continue;
      const FaceStrength face = strengths->of(tet - first, beyond - first);
      own_[i] = rocks.of(face.joint, face.tensile_strength, face.cohesion);
      rocks.take(face.joint, own_[i]);
    }
    double due = std::min(looked_at_from, due_at), half = freed_at;
    for (auto t = chunk.tets.begin; t < chunk.tets.end; ++t)
      if (const int star = star_of(model, t); star >= 0) {
        due = std::min(due, stars_due_at * star_blocks.shape[star]);
        half = std::min(half, stars_freed_at * star_blocks.shape[star]);
      }
    bounds_[c] = {rocks.bounds(1), rocks.bounds(due), rocks.bounds(half)};
    bounds_[c].harmless = std::sqrt(harmless_norm2(bounds_[c].whole));
  }
  freed(model);
  kept_ = true;
}

FacePlane StrengthWatch::plane_between(const Model& model, int tet_a, int tet_b) const {
  if (plane_.empty())
    return FacePlane::of_material;
  const int first = model.mesh.first_tet;
  for (int face = 0; face < 4; ++face)
    if (const int i = 4 * (tet_a - first) + face; neighbours_[i] >= 0 && neighbours_[i] / 4 == tet_b - first)
      return plane_[static_cast<std::size_t>(i)];
  return FacePlane::of_material;
}

bool StrengthWatch::is_nearest_of_a_tet(const Model& model, const State& state, const FaceTets& tets,
                                        const geom::Vec3& face, const geom::Vec3& m) const {
  const MeshData& mesh = model.mesh;
  const double cosine = std::abs(face.dot(m)) * (1 + 1e-9);
  const auto is_nearest_of = [&](int tet) {
    const Body& body = model.bodies[model.blocks[model.tet_block[tet]].body];
    const int i = tet - mesh.first_tet;
    const auto place = [&](int corner) { return place_of(model, state, model.tets[tet][corner]); };
    for (int f = 0; f < 4; ++f) {
      const int beyond = neighbours_[4 * i + f];
      if (beyond < 0 || !body.bonding.bonds(mesh.region[i], mesh.region[beyond / 4]))
        continue;
      const auto& at = geom::tet_faces[f];
      const geom::Vec3 normal = (place(at[1]) - place(at[0])).cross(place(at[2]) - place(at[0])).normalized();
      if (std::abs(normal.dot(m)) > cosine)
        return false;
    }
    return true;
  };
  return is_nearest_of(tets.tet_a) || is_nearest_of(tets.tet_b);
}

// A border that a mesh follows is smooth: of the three faces beyond the edges of a face at most one stands far off it, where
// the border has an edge. A ragged border, which only says to which region each tet belongs, has no plane of its own: its
// faces, and those beside them, are judged as faces of the material; all of the border's, where most are ragged.
void StrengthWatch::find_planes(const Model& model) {
  // Least cosine between faces side by side, of 20 degrees: a circle of 18 edges is smooth.
  constexpr double smooth = 0.93969262078590838;
  const MeshData& mesh = model.mesh;
  struct BorderFace {
    std::size_t at;
    geom::Vec3 normal;
    std::array<std::pair<int, int>, 3> edges; // by the numbers that all copies of a node have
    std::array<int, 3> between;               // body and regions
    bool ragged;
  };
  std::vector<BorderFace> border;
  std::map<std::pair<int, int>, std::vector<std::size_t>> around; // of each edge: into border
  for (std::size_t i = 0; i < neighbours_.size(); ++i) {
    const int tet = static_cast<int>(i / 4), beyond = neighbours_[i] / 4;
    if (neighbours_[i] < 0 || beyond < tet)
      continue;
    const Body& body = model.bodies[model.blocks[model.tet_block[mesh.first_tet + tet]].body];
    if (!body.bonding.is_cohesive())
      continue;
    const int a = mesh.region[tet], b = mesh.region[beyond];
    if (a == b || (body.bonding.everywhere && body.region_laws.between(a, b) < 0))
      continue;
    std::array<int, 3> corners{};
    for (int k = 0; k < 3; ++k)
      corners[k] = model.tets[mesh.first_tet + tet][geom::tet_faces[i % 4][k]];
    const auto place = [&](int k) { return model.node_position[corners[k]]; };
    BorderFace face{
        i,
        (place(1) - place(0)).cross(place(2) - place(0)).normalized(),
        {},
        {model.blocks[model.tet_block[mesh.first_tet + tet]].body, std::min(a, b), std::max(a, b)},
        false};
    for (int k = 0; k < 3; ++k) {
      const int one = mesh.original[corners[k] - mesh.first_node],
                other = mesh.original[corners[(k + 1) % 3] - mesh.first_node];
      face.edges[k] = std::minmax(one, other);
      around[face.edges[k]].push_back(border.size());
    }
    border.push_back(face);
  }
  if (border.empty())
    return;
  const auto count_beside = [&](const BorderFace& face, const auto& is) { // edges beyond which one is
    return std::count_if(face.edges.begin(), face.edges.end(), [&](const auto& edge) {
      const std::vector<std::size_t>& beside = around.at(edge);
      return std::any_of(beside.begin(), beside.end(), [&](std::size_t other) { return is(border[other]); });
    });
  };
  for (BorderFace& face : border)
    face.ragged = count_beside(face, [&](const BorderFace& other) {
                    return std::abs(other.normal.dot(face.normal)) < smooth;
                  }) > 1;
  std::map<std::array<int, 3>, std::int64_t> most; // > 0: more ragged faces than others
  for (const BorderFace& face : border)
    most[face.between] += face.ragged ? 1 : -1;
  plane_.assign(neighbours_.size(), FacePlane::of_material);
  for (const BorderFace& face : border)
    plane_[face.at] = plane_[static_cast<std::size_t>(neighbours_[face.at])] =
        most[face.between] <= 0 &&
                count_beside(face, [](const BorderFace& other) { return other.ragged; }) == 0
            ? FacePlane::own
            : FacePlane::of_ragged_border;
}

// The faces of one chunk that may crack and are not freed yet.
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

void StrengthWatch::freed(const Model& model) {
  const MeshData& mesh = model.mesh;
  kept_ = false;
  open_.assign(mesh.batches.size(), 0);
  held_.assign(mesh.chunks.size(), 0);
  slots_.assign(mesh.faces.size(), {});
  half_freed_.assign(mesh.faces.size(), 0);
  each_face(mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    const FaceTets& tets = mesh.face_tets[batch * lanes + lane];
    slots_[batch].a[lane] = mesh.tet_slot[tets.tet_a - mesh.first_tet];
    slots_[batch].b[lane] = mesh.tet_slot[tets.tet_b - mesh.first_tet];
    const geom::Triangle nodes = face_nodes(mesh, chunk, batch, lane).a;
    if (plane_between(model, tets.tet_a, tets.tet_b) == FacePlane::own &&
        std::any_of(nodes.begin(), nodes.end(),
                    [&](int node) { return mesh.freed[node - mesh.first_node] == 0; }))
      half_freed_[batch] |= static_cast<std::uint8_t>(1u << lane);
  });
  facets_.assign(mesh.chunks.size(), {});
  std::map<std::pair<int, int>, FacetFaces> facets; // of a chunk, by star blocks
  for (std::size_t c = 0; c < mesh.chunks.size() && !star_.empty(); ++c, facets.clear()) {
    for (int face = 0; face < mesh.chunks[c].faces; ++face) {
      const FaceTets& tets = mesh.face_tets[mesh.chunks[c].face_batches.begin * lanes + face];
      const int a = star_of(model, tets.tet_a), b = star_of(model, tets.tet_b);
      if (a < 0 || b < 0 || a == b || plane_between(model, tets.tet_a, tets.tet_b) != FacePlane::own)
        continue;
      FacetFaces& of = facets[std::minmax(a, b)];
      of.faces.push_back(face);
      of.first_is_a.push_back(a < b ? 1 : 0);
    }
    for (auto& [stars, of] : facets)
      if (is_plane(model, mesh.chunks[c], of))
        facets_[c].push_back(std::move(of));
  }
  open_star_.assign(star_.empty() ? 0 : 1 + *std::max_element(star_.begin(), star_.end()), 0);
  // Those of the stars are known once all tets of their stars have been seen.
  for (const bool of_stars : {false, true})
    for (std::size_t c = 0; c < mesh.chunks.size(); ++c) {
      if (!looks_at(static_cast<std::int64_t>(c)))
        continue;
      const MeshChunk& chunk = mesh.chunks[c];
      const ChunkFaces faces(*this, model, chunk);
      for (std::int64_t t = chunk.tets.begin; t < chunk.tets.end; ++t) {
        const int star = star_of(model, t);
        const bool open = of_stars ? star >= 0 && open_star_[star] != 0 : faces.any_open(t);
        if (open && star >= 0)
          open_star_[star] = 1;
        if (open)
          open_[chunk.batches.begin + (t - chunk.tets.begin) / lanes] = held_[c] = 1;
      }
    }
}

template <class Visit>
void StrengthWatch::each_half_freed(const MeshChunk& chunk, const Visit& visit) const {
  for (std::int64_t batch = chunk.face_batches.begin; batch < chunk.face_batches.end; ++batch)
    for (unsigned bits = half_freed_[batch]; bits != 0; bits &= bits - 1)
      visit(batch, __builtin_ctz(bits));
}

void StrengthWatch::look(const MeshChunk& chunk, std::int64_t index, const StressBatch* stress,
                         const StressBatch* before, NearStrength& near) const {
  constexpr double steps_ahead = 2; // the stress is that of a step ago, and the next look is a step away
  const std::vector<UtilisationBound>& bounds = bounds_[static_cast<std::size_t>(index)].at_strength;
  find_near(stress, before, chunk.batches.size(), bounds, steps_ahead,
            near.bits.data() + chunk.batches.begin);
}

void StrengthWatch::look(const Model& model, const State& state, Range chunks, int threads,
                         NearStrength& near) const {
  // Tets of other ranks count as near: nobody has looked at them here.
  near.bits.assign(model.mesh.batches.size(), NearStrength::may_crack);
  near.forget_pulls(model);
  for_chunks(chunks, threads, [&](std::int64_t c) {
    const MeshChunk& chunk = model.mesh.chunks[c];
    if (looks_at(c))
      look(chunk, c, state.stress.data() + chunk.batches.begin, nullptr, near);
  });
  near.crack_known = true;
}

std::vector<char> StrengthWatch::due(const Model& model, const State& state, const NearStrength& near,
                                     Range own, int threads, double ahead, bool everywhere) const {
  std::vector<char> due(model.mesh.chunks.size(), 0);
  for_chunks(own, threads, [&](std::int64_t c) {
    if (!looks_at(c) || !has_held_faces(c))
      return;
    const MeshChunk& chunk = model.mesh.chunks[c];
    const ChunkFaces faces(*this, model, chunk);
    const std::vector<UtilisationBound>& bounds = bounds_[static_cast<std::size_t>(c)].at_strength;
    const std::vector<char> loaded =
        everywhere ? loaded_batches(model, state, chunk, bounds, ahead) : std::vector<char>();
    for (std::int64_t b = chunk.batches.begin; b < chunk.batches.end && due[c] == 0; ++b) {
      if (open_[b] == 0 || (everywhere ? loaded[b - chunk.batches.begin] == 0
                                       : (near.bits[b] & NearStrength::may_be_due) == 0))
        continue;
      const std::int64_t first = chunk.tets.begin + (b - chunk.batches.begin) * lanes;
      for (std::int64_t t = first; t < std::min(first + lanes, chunk.tets.end); ++t)
        if (const int star = star_of(model, t); star >= 0)
          due[c] = due[c] != 0 || (open_star_[star] != 0 && faces.may_reach(bounds, state, t, ahead)) ? 1 : 0;
        else
          for (int face = faces.may_reach(bounds, state, t, ahead) ? 0 : 4; face < 4; ++face)
            if (faces.is_open(t, face) && faces.utilisation(state, t, face, ahead) >= due_at)
              due[c] = 1;
    }
    each_half_freed(chunk, [&](std::int64_t batch, int lane) {
      if (due[c] == 0 && faces.half_freed(state, batch, lane, ahead, harmless_stress(c)) >= due_at)
        due[c] = 1;
    });
  });
  std::vector<std::int64_t> of_body(model.bodies.size(), 0);
  for (std::size_t c = 0; c < due.size(); ++c)
    of_body[model.blocks[model.mesh.chunks[c].block].body] += due[c];
  ranks().sum(of_body.data(), of_body.size());
  std::vector<char> bodies(of_body.size(), 0);
  std::transform(of_body.begin(), of_body.end(), bodies.begin(),
                 [](std::int64_t chunks) { return static_cast<char>(chunks > 0); });
  return bodies;
}

std::vector<char> StrengthWatch::to_free(const Model& model, const State& state,
                                         const std::vector<char>& bodies, int threads, double ahead) const {
  std::vector<std::vector<int>> found(model.mesh.chunks.size()), stars_of(found.size()); // nodes; star blocks
  const auto of_bodies = [&](std::int64_t c) {
    return looks_at(c) && has_held_faces(c) && bodies[model.blocks[model.mesh.chunks[c].block].body] != 0;
  };
  const auto add_face = [&](std::int64_t c, std::int64_t tet, int face) {
    for (const int corner : geom::tet_faces[face])
      found[static_cast<std::size_t>(c)].push_back(model.tets[tet][corner]);
  };
  for_chunks(static_cast<std::int64_t>(found.size()), threads, [&](std::int64_t c) {
    const MeshChunk& chunk = model.mesh.chunks[c];
    if (!of_bodies(c))
      return;
    const ChunkFaces faces(*this, model, chunk);
    const std::vector<UtilisationBound>& bounds = bounds_[static_cast<std::size_t>(c)].at_half;
    const std::vector<char> loaded = loaded_batches(model, state, chunk, bounds, ahead);
    for (std::int64_t t = chunk.tets.begin; t < chunk.tets.end; ++t) {
      const std::int64_t batch = (t - chunk.tets.begin) / lanes;
      if (open_[chunk.batches.begin + batch] == 0 || loaded[batch] == 0)
        continue;
      if (!faces.may_reach(bounds, state, t, ahead))
        continue;
      if (const int star = star_of(model, t); star >= 0)
        stars_of[c].push_back(star);
      else
        for (int face = 0; face < 4; ++face)
          if (faces.is_open(t, face) && faces.utilisation(state, t, face, ahead) >= freed_at)
            add_face(c, t, face);
    }
    each_half_freed(chunk, [&](std::int64_t batch, int lane) {
      if (faces.half_freed(state, batch, lane, ahead, harmless_stress(c)) >= freed_at)
        for (const int node : face_nodes(model.mesh, chunk, batch, lane).a)
          found[c].push_back(node);
    });
  });
  std::set<int> stars;
  for (const std::vector<int>& of : stars_of)
    stars.insert(of.begin(), of.end());
  for (std::size_t c = 0; c < found.size() && !stars.empty(); ++c)
    if (of_bodies(static_cast<std::int64_t>(c))) {
      const MeshChunk& chunk = model.mesh.chunks[c];
      const ChunkFaces faces(*this, model, chunk);
      for (std::int64_t t = chunk.tets.begin; t < chunk.tets.end; ++t)
        for (int face = stars.count(star_of(model, t)) != 0 ? 0 : 4; face < 4; ++face)
          if (faces.is_open(t, face))
            add_face(static_cast<std::int64_t>(c), t, face);
    }
  std::vector<char> nodes(model.node_position.size(), 0);
  for (const std::vector<int>& of : found)
    for (const int node : of)
      nodes[node] = 1;
  return nodes;
}

std::vector<char> StrengthWatch::to_join(const Model& model, const State& state, Range own,
                                         int threads) const {
  const MeshData& mesh = model.mesh;
  // Nodes that stay as they are, by their originals; behind them star blocks, all nodes of which stay.
  std::vector<std::vector<int>> found(mesh.chunks.size());
  const int originals =
      mesh.original.empty() ? 0 : 1 + *std::max_element(mesh.original.begin(), mesh.original.end());
  for_chunks(own, threads, [&](std::int64_t c) {
    if (!looks_at(c))
      return;
    const MeshChunk& chunk = mesh.chunks[c];
    const ChunkFaces faces(*this, model, chunk);
    const auto stays = [&](int node) { found[c].push_back(mesh.original[node - mesh.first_node]); };
    const Elastic& rock = model.bodies[model.blocks[chunk.block].body].material;
    const double calm =
        calm_for * model.blocks[chunk.block].size / std::sqrt(rock.p_wave_modulus() / rock.density);
    const std::vector<UtilisationBound>& bounds = bounds_[static_cast<std::size_t>(c)].at_half;
    const std::vector<char> loaded = loaded_batches(model, state, chunk, bounds, 0);
    for (std::int64_t t = chunk.tets.begin; t < chunk.tets.end; ++t) {
      const int slot = mesh.tet_slot[t - mesh.first_tet];
      if (state.time - state.near_at[slot / lanes].time[slot % lanes] < calm ||
          (loaded[slot / lanes - chunk.batches.begin] != 0 && faces.may_reach(bounds, state, t, 0))) {
        for (const int node : model.tets[t])
          stays(node);
        if (const int star = star_of(model, t); star >= 0)
          found[c].push_back(originals + star);
      }
    }
    for (int face = 0; face < chunk.faces; ++face) {
      const std::int64_t batch = chunk.face_batches.begin + face / lanes;
      const FaceStateBatch& at = state.faces[batch];
      const int lane = face % lanes;
      if (at.stage[lane] == FaceStage::holding && at.preloaded[lane] == 0 && is_untouched(state, batch, lane))
        continue;
      for (const int node : face_nodes(mesh, chunk, batch, lane).a)
        stays(node);
    }
  });
  std::string staying(static_cast<std::size_t>(originals) + open_star_.size(), 0);
  for (const std::vector<int>& of : found)
    for (const int original : of)
      staying[original] = 1;
  const std::vector<std::string> of_ranks = ranks().gather(staying);
  for (const std::string& of_rank : of_ranks)
    for (std::size_t i = 0; i < staying.size(); ++i)
      staying[i] = static_cast<char>(staying[i] | of_rank[i]);
  for (std::size_t tet = 0; tet < star_.size(); ++tet)
    if (star_[tet] >= 0 && staying[originals + star_[tet]] != 0)
      for (const int node : model.tets[mesh.first_tet + tet])
        staying[mesh.original[node - mesh.first_node]] = 1;
  std::vector<char> nodes(model.node_position.size(), 0);
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const Block& block = model.blocks[b];
    if (block.convex() || block.rigid >= 0)
      continue;
    std::int64_t freed = 0, joined = 0;
    const auto each = [&](const auto& visit) {
      for (int node = block.node_begin; node < block.node_end; ++node)
        if (mesh.freed[node - mesh.first_node] != 0) {
          ++freed;
          if (staying[mesh.original[node - mesh.first_node]] == 0)
            visit(node);
        }
    };
    each([&](int) { ++joined; });
    if (joined > 0 && static_cast<double>(joined) >= worth_joining * static_cast<double>(freed))
      each([&](int node) { nodes[node] = 1; });
  }
  return nodes;
}

} // namespace cdem
