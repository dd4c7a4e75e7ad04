#include "libcdem/step/stage.hpp"

#include <algorithm>

namespace cdem {
namespace {

// Chunks a thread must have before a further one is worth its two barriers a step: about half a millisecond of work.
constexpr std::int64_t chunks_per_thread = 32;
// The same where contacts are looked for, which is most of the work of a pile.
constexpr std::int64_t touching_chunks_per_thread = 6;
// A chunk of a continuous mesh counts as one for each so many tets.
constexpr std::int64_t usual_chunk = 512;

} // namespace

int useful_threads(const Model& model, int threads) {
  const auto meshes = static_cast<std::int64_t>(model.mesh.chunks.size());
  std::int64_t chunks = static_cast<std::int64_t>(model.chunks.size()) - meshes;
  for (const MeshChunk& chunk : model.mesh.chunks)
    chunks += std::max<std::int64_t>(1, chunk.tets.size() / usual_chunk);
  const std::int64_t each = model.surface.empty() ? chunks_per_thread : touching_chunks_per_thread;
  return static_cast<int>(std::clamp<std::int64_t>(chunks / each, 1, threads));
}

} // namespace cdem
