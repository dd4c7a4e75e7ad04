#include "libcdem/fracture/strength_watch.hpp"

#include "libcdem/fracture/held_faces.hpp"
#include "libcdem/fracture/own_rocks.hpp"
#include "libcdem/fracture/star_blocks.hpp"
#include "libcdem/fracture/stress_bounds.hpp"
#include "libcdem/model/build/face_strength.hpp"
#include "libcdem/model/build/freed_meshes.hpp"
#include "libcdem/model/known_of_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace cdem {
namespace {

// What may be asked of a face that has resumed holding is at least this part of its strength (may_end, bond/freed_face.hpp).
constexpr double looked_at_from = 0.9;

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

KnownOfModel<StrengthWatch>& known_watches() {
  static KnownOfModel<StrengthWatch> known;
  return known;
}

} // namespace

void NearStrength::forget_pulls(const Model& model) {
  pull2.assign(model.mesh.faces.size() * lanes, std::numeric_limits<double>::infinity());
}

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

} // namespace cdem
