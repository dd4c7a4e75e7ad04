#include "libcdem/bond/fragments.hpp"
#include "libcdem/fracture/held_faces.hpp"
#include "libcdem/ranks/ranks.hpp"

#include <cmath>
#include <string>

namespace cdem {
namespace {

// How long tets have been below `due_at` before nodes are joined, in times that a wave takes through the block; and the least
// part of the freed nodes of a block for which it is worth while.
constexpr double calm_for = 10, worth_joining = 0.1;

} // namespace

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
