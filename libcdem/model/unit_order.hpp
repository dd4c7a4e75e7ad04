// Blocks as scripts count them. Model::blocks stands in an order that is good for the caches (first_model); ids are given in the order in
// which the blocks were built.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

std::vector<int> blocks_by_id(const Model&); // indices of all blocks, ids ascending (n_blocks)

// The units of a body, first unit first: indices of its blocks, ids ascending. Empty where no body has the name.
std::vector<int> units_of_body(const Model&, const std::string& body);

} // namespace cdem
