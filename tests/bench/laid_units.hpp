// Armour units of a few hundred tetrahedra laid on a slope as one layer between two walls.
#pragma once

#include "libcdem/first_model.hpp"
#include "libcdem/load/conditions.hpp"

namespace bench {

struct Laid {
  cdem::ModelSpec spec;
  cdem::Conditions conditions;
  std::size_t tets_per_unit = 0;
};
Laid laid_units(int count, bool rigid); // rigid from the start

} // namespace bench
