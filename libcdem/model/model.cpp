// What a node has by its block: cheaper to look up where it is asked for than to keep for every node.
#include "libcdem/model/model.hpp"

#include <algorithm>

namespace cdem {

bool is_rigid(const Model& model, const MeshChunk& chunk) {
  for (std::int64_t b = chunk.blocks.begin; b < chunk.blocks.end; ++b)
    if (model.blocks[b].rigid < 0)
      return false;
  return true;
}

int block_of(const Model& model, int node) {
  const auto after = std::upper_bound(model.blocks.begin(), model.blocks.end(), node,
                                      [](int n, const Block& block) { return n < block.node_begin; });
  return static_cast<int>(after - model.blocks.begin()) - 1;
}

double node_volume(const Model& model, int node) {
  return model.node_mass[node] / model.bodies[model.blocks[block_of(model, node)].body].material.density;
}

} // namespace cdem
