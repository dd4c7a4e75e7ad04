// Divides the strengths of a model by a factor (joint/strength_reduction.hpp). Nothing else of it changes.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

struct StrengthKinds {
  bool joints = false; // joints between blocks, bonds of meshes, contacts
  bool blocks = false; // plasticity
};

// Throws geom::InputError where what is asked for has no strength.
void reduce_strength(Model&, double factor, const StrengthKinds&);

} // namespace cdem
