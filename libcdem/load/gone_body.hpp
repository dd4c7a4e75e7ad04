// Conditions on bodies of which nothing is left in the model.
#pragma once

#include "libcdem/load/conditions.hpp"

namespace cdem {

struct Model;

// All of a body that the selection names has been taken out of the model: the condition ends with it.
bool is_gone(const Model&, const Selection&);

// Throws geom::InputError where a support or load is on such a body.
void refuse_gone(const Model&, const Conditions&);

} // namespace cdem
