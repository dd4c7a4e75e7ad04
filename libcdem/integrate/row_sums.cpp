#include "libcdem/integrate/row_sums.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/model/known_of_model.hpp"

#include <cmath>

namespace cdem {

std::vector<double> element_row_sums(const Model& model) {
  static KnownOfModel<std::vector<double>> known;
  return *known.of(model, [&] {
    std::vector<double> sums = stiffness_row_sums(model);
    add_mesh_row_sums(model, sums);
    return sums;
  });
}

std::vector<double> all_row_sums(const Model& model) {
  std::vector<double> sums = element_row_sums(model);
  add_spring_row_sums(model, sums);
  return sums;
}

double stable_time_step(double frequency2, double rate) {
  return 4 / (rate + std::sqrt(rate * rate + 4 * frequency2));
}

double damping_of(const Model& model, int node) {
  double beta = model.bodies[model.blocks[block_of(model, node)].body].material.stiffness_damping;
  if (!model.bond_begin.empty())
    for (std::int64_t i = model.bond_begin[node]; i < model.bond_begin[node + 1]; ++i) {
      const Interface& interface = model.interfaces[model.points[model.spring_ends[i].point()].interface];
      beta = std::max(beta, model.joints[interface.joint].stiffness_damping);
    }
  return beta;
}

} // namespace cdem
