#include "libcdem/integrate/row_sums.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/model/known_of_model.hpp"

#include <cmath>

namespace cdem {
namespace {

KnownOfModel<std::vector<double>>& known_sums() {
  static KnownOfModel<std::vector<double>> known;
  return known;
}

} // namespace

std::vector<double> element_row_sums(const Model& model) {
  return *known_sums().of(model, [&] {
    std::vector<double> sums = stiffness_row_sums(model);
    add_mesh_row_sums(model, sums);
    return sums;
  });
}

void renew_row_sums(const Model& before, const Model& now, const std::vector<int>& old_node,
                    const std::vector<int>& tets) {
  std::vector<char> rows(now.node_position.size(), 0), near(now.tets.size(), 0);
  for (const int tet : tets) {
    near[tet] = 1;
    for (const int node : now.tets[tet])
      rows[node] = 1;
  }
  each_side(now.mesh, [&](int tet, int, const geom::Triangle&, const geom::Triangle& beyond) {
    for (const int node : beyond)
      rows[node] |= near[tet];
  });
  const std::vector<double> old = element_row_sums(before);
  known_sums().of(now, [&] {
    std::vector<double> sums(rows.size(), 0);
    for (std::size_t node = 0; node < rows.size(); ++node)
      if (rows[node] == 0)
        sums[node] = old[old_node[node]];
    add_mesh_row_sums(now, sums, rows);
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
