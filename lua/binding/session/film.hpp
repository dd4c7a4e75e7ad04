// A film that is taken while a model is solved.
#pragma once

#include "lua/binding/schema/schema.hpp"

#include "libcdem/step/timed_look.hpp"

namespace cdem::script {

struct Film {
  std::string file;
  Arguments frame; // of model:picture, without file
  TimedLook when;  // without its look
  int frames_per_second = 12;
  std::size_t written = 0; // frames of the file so far
};

} // namespace cdem::script
