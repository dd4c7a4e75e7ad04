#include "libcdem/integrate/mass_scaling.hpp"

#include "libcdem/integrate/row_sums.hpp"

namespace cdem {

double least_mass(double row_sum, double damping, double step) {
  return row_sum * step * (step + 2 * damping) / 4;
}

std::vector<double> scaled_masses(const Model& model, const std::vector<double>& row_sums, double step) {
  std::vector<double> masses = model.node_mass;
  for (const Block& block : model.blocks) {
    if (block.rigid >= 0)
      continue;
    for (int i = block.node_begin; i < block.node_end; ++i)
      masses[i] = std::max(masses[i], least_mass(row_sums[i], block.meshed ? damping_of(model, i) : 0, step));
  }
  return masses;
}

AddedMass added_mass(const Model& model, const std::vector<double>& moving) {
  std::vector<double> own(model.bodies.size(), 0.0), added(model.bodies.size(), 0.0);
  for (const Block& block : model.blocks) {
    if (block.rigid >= 0)
      continue;
    for (int i = block.node_begin; i < block.node_end; ++i) {
      own[block.body] += model.node_mass[i];
      added[block.body] += moving[i] - model.node_mass[i];
    }
  }
  AddedMass result;
  double all = 0, all_added = 0;
  for (int body = 0; body < static_cast<int>(own.size()); ++body) {
    all += own[body];
    all_added += added[body];
    if (added[body] > 0 && added[body] > result.body_share * own[body]) {
      result.body = body;
      result.body_share = added[body] / own[body];
    }
  }
  if (all > 0)
    result.share = all_added / all;
  return result;
}

} // namespace cdem
