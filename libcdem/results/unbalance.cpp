#include "libcdem/results/unbalance.hpp"

#include "libgeom/core/check.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

// N, of each block; buoyancy taken off.
std::vector<double> weights_of_blocks(const Model& model, const std::optional<Gravity>& gravity) {
  std::vector<double> weights;
  for (const Block& block : model.blocks) {
    const double density = model.bodies[block.body].material.density;
    const double less = gravity ? std::abs(density - gravity->water_density) : 0;
    weights.push_back(gravity ? less * block.mass.volume * gravity->acceleration.norm() : 0);
  }
  return weights;
}

} // namespace

Unbalance unbalance(const Model& model, const ResolvedConditions& r, const std::vector<Node>& force,
                    const std::optional<Gravity>& gravity, std::optional<double> reference) {
  if (reference)
    geom::require_above("reference", *reference, 0, "N");
  const std::vector<double> weights = weights_of_blocks(model, gravity);
  if (!reference && *std::min_element(weights.begin(), weights.end()) <= 0)
    throw geom::InputError("reference", "missing", "a force (N) to compare with where no gravity acts",
                           "give reference = ..., or call model:gravity first");
  Unbalance result;
  double sum = 0;
  std::int64_t count = 0;
  const auto add = [&](std::int64_t node, const Node& free) {
    const int b = block_of(model, static_cast<int>(node));
    if (model.blocks[b].rigid >= 0 || free.x + free.y + free.z == 0)
      return;
    const Node& f = force[node];
    const double net = geom::Vec3(free.x * f.x, free.y * f.y, free.z * f.z).norm();
    const double ratio = net / reference.value_or(weights[b]);
    sum += ratio;
    ++count;
    if (ratio > result.largest)
      result = {ratio, 0, net, model.blocks[b].id, model.node_position[node]};
  };
  each_node(
      r, {0, static_cast<std::int64_t>(force.size())},
      [&](Range nodes) {
        for (std::int64_t node = nodes.begin; node < nodes.end; ++node)
          add(node, {1, 1, 1, 0});
      },
      [&](const HeldNode& h) { add(h.node, h.free); });
  result.mean = count > 0 ? sum / static_cast<double>(count) : 0;
  return result;
}

} // namespace cdem
