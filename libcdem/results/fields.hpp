// Named values of a state: "displacement.x", "velocity.magnitude" at nodes; "stress.xy", "principal_stress.1",
// "von_mises" as volume means of convex blocks, and of each tet of a mesh.
#pragma once

#include "libcdem/model/selection.hpp"
#include "libcdem/results/tet_at_place.hpp"
#include "libcdem/state/state.hpp"

namespace cdem {

std::vector<std::string> field_names();

struct FieldValue {
  double value = 0;
  geom::Vec3 place = geom::Vec3::Zero(); // m, undeformed
  std::int64_t block = -1;               // id
};

// Every selected value: one per node or per block. Throws geom::InputError for an unknown name (the nearest right one
// is named) and for a selection that holds nothing.
std::vector<FieldValue> values(const Model&, const State&, const std::string& field, const Selection&);

// Mean over the uncovered area of the selected outer faces for a nodal field on a side or plane that has some;
// otherwise over the volume around the nodes, or of the blocks.
double mean_value(const Model&, const State&, const std::string& field, const Selection&);

// Interpolated in the tet that holds the place (nodal fields), or of the block that does. Throws geom::InputError
// when the place lies in no block.
double value_at(const Model&, const State&, const std::string& field, const geom::Vec3& place);

// The same for who asks at many places; nothing where the place lies in no block.
std::optional<double> value_at(const Model&, const State&, const std::string& field, const geom::Vec3& place,
                               const TetsByPlace&);

// A field's name checked; throws geom::InputError as above.
void check_field(const std::string& field);

// Principal stresses, Pa, tension positive, largest first.
std::array<double, 3> principal(const Stress&);
double von_mises(const Stress&);

} // namespace cdem
