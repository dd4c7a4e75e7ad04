// Builds the first Model from the user's input.
#pragma once

#include "libcdem/model/model.hpp"
#include "libcdem/simulation.hpp"

#include <array>
#include <vector>

namespace cdem {

Model first_model(const ModelSpec&); // throws geom::InputError

// Each law of the body's joint sets and cuts has faces. Throws geom::InputError.
void require_set_names(const BodySpec&);

// Bodies, smaller first, for which the spec gives a law and that share no face: two that it names, and the blocks of one.
std::vector<std::array<int, 2>> pairs_without_interface(const ModelSpec&, const Model&);

} // namespace cdem
