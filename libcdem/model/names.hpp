// What messages call the parts of a model.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// unit 3 of "units", or "slope" when it is the body's only one.
std::string block_name(const Model&, int block);

// Throws geom::InputError: no body has this name; the names there are.
[[noreturn]] void refuse_body(const std::string& field, const std::string& name, const Model&);

} // namespace cdem
