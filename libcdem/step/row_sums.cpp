#include "libcdem/step/row_sums.hpp"

#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/interface/spring_forces.hpp"

namespace cdem {

std::vector<double> all_row_sums(const Model& model) {
  std::vector<double> sums = stiffness_row_sums(model);
  add_mesh_row_sums(model, sums);
  add_spring_row_sums(model, sums);
  return sums;
}

} // namespace cdem
