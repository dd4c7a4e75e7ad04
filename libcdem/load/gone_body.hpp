// Places of conditions, of which nothing may be left in the model.
#pragma once

#include "libcdem/load/conditions.hpp"

namespace cdem {

struct Model;

// All of a body that the selection names has been taken out of the model: the condition ends with it.
bool is_gone(const Model&, const Selection&);
bool is_gone(const Model&, const Flow&); // each of its places

// Throws geom::InputError where a support or load acts on nothing. It is asked when the condition is given: where all of its
// place is removed later, it acts on nothing from then on.
void require_places(const Model&, const Conditions&);

} // namespace cdem
