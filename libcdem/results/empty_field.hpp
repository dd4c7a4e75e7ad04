// A field of a Snapshot without values yet.
#pragma once

#include "libcdem/results/snapshot.hpp"

#include <utility>

namespace cdem {

inline SnapshotField empty_field(std::string name, std::string unit, int components = 1,
                                 bool integer = false) {
  SnapshotField field;
  field.name = std::move(name);
  field.unit = std::move(unit);
  field.components = components;
  field.integer = integer;
  return field;
}

} // namespace cdem
