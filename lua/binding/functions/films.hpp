// Films that a model's stages take.
#pragma once

#include "libcdem/step/timed_look.hpp"

#include <vector>

namespace cdem::script {

struct Session;
struct ModelObject;

// For the next stage of the model.
std::vector<TimedLook> film_looks(Session&, ModelObject&);

} // namespace cdem::script
