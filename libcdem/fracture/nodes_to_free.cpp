#include "libcdem/fracture/held_faces.hpp"
#include "libcdem/ranks/ranks.hpp"

#include <set>

namespace cdem {

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

} // namespace cdem
