// What messages call the parts of a model.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

std::string block_name(const Model&,
                       int block); // unit 3 of "units", or "slope" when it is the body's only one

} // namespace cdem
