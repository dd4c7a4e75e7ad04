// Meshed blocks that overlap before anything has moved.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// Throws geom::InputError for two meshed blocks that pierce each other, or hold each other, by more than 0.01 of the
// smaller one's size, and for two that are nearer than 1e-3 of it without a law between them.
void require_separate_meshes(const Model&);

} // namespace cdem
