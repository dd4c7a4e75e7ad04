// One number per point or surface triangle from a field name such as "stress.xx".
#pragma once

#include "libcdem/results/snapshot.hpp"

#include <string>
#include <vector>

namespace cdem {

struct FieldValues {
  bool on_points = true;
  std::vector<double> values;          // per point, or per surface triangle
  std::string symbol;                  // "u_{x}", as the colour bar names it
  std::string unit;                    // SI
  bool integer = false;                // ids, modes, counts
  bool id = false;                     // a name in numbers: its size means nothing
  std::vector<std::string> names = {}; // of the numbers 0, 1, ...
};

// Throws geom::InputError of a colour (as pictures call it), naming the nearest right names.
FieldValues field_values(const Snapshot&, const std::string& field);

// Takes the values of these bodies away (NaN): they are drawn without colour.
void leave_plain(const Snapshot&, const std::vector<int>& bodies, FieldValues&);
// The same of points inside: colours reach over what is seen.
void leave_inside(const Snapshot&, FieldValues&);

// The field of that name, or nullptr.
const SnapshotField* find_field(const std::vector<SnapshotField>&, const std::string& name);

// The point field "displacement", m, or nullptr.
const SnapshotField* displacement_of(const std::vector<SnapshotField>& point_fields);

} // namespace cdem
