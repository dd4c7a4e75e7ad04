// From what the user states to the first Model.
#pragma once

#include "libcdem/model/model.hpp"
#include "libcdem/simulation.hpp"

namespace cdem {

Model first_model(const ModelSpec&); // throws geom::InputError

} // namespace cdem
