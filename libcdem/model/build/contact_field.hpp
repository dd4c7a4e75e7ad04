// From the meshes of a Model to the pressure field of its blocks.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// Fills model.field for model.surface; empty unless the contact method is the field.
void build_field(Model&);

// Throws geom::InputError where the field cannot do yet what the model asks for.
void require_field_can(const Model&);

} // namespace cdem
