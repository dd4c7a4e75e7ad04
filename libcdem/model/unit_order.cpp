#include "libcdem/model/unit_order.hpp"

#include <numeric>

namespace cdem {

std::vector<int> blocks_by_id(const Model& model) {
  std::vector<int> blocks(model.blocks.size());
  std::iota(blocks.begin(), blocks.end(), 0);
  std::sort(blocks.begin(), blocks.end(),
            [&](int a, int b) { return model.blocks[a].id < model.blocks[b].id; });
  return blocks;
}

std::vector<int> units_of_body(const Model& model, const std::string& body) {
  std::vector<int> units = blocks_by_id(model);
  units.erase(std::remove_if(units.begin(), units.end(),
                             [&](int b) { return model.bodies[model.blocks[b].body].name != body; }),
              units.end());
  return units;
}

} // namespace cdem
