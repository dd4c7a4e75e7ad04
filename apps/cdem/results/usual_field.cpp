#include "apps/cdem/results/usual_field.hpp"

#include "libcdem/vtk/field_values.hpp"

namespace cdem::app {

std::string usual_field(const Snapshot& snapshot) {
  if (displacement_of(snapshot.point_fields))
    return "displacement.magnitude";
  if (find_field(snapshot.cell_fields, "region"))
    return "region";
  for (const SnapshotField& field : snapshot.cell_fields)
    if (field.components == 1)
      return field.name;
  return "";
}

} // namespace cdem::app
