#include "libcdem/integrate/viscous_forces.hpp"

#include <algorithm>

namespace cdem {

std::vector<double> viscous_forces(const Model& model) {
  std::vector<double> viscous;
  if (std::all_of(model.bodies.begin(), model.bodies.end(),
                  [](const Body& body) { return body.material.viscosity == 0; }))
    return viscous;
  viscous.reserve(model.node_position.size());
  for (int i = 0; i < static_cast<int>(model.node_position.size()); ++i) {
    const Elastic& material = model.bodies[model.blocks[block_of(model, i)].body].material;
    viscous.push_back(material.viscosity *
                      (model.node_mass[i] / material.density)); // every motion fades alike
  }
  return viscous;
}

} // namespace cdem
