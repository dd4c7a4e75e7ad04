// The Lua side of the module (lua/cdem/*.lua) and the examples of the reference (lua/examples/*.lua), put into the program by CMake.
#pragma once

namespace cdem::script {

struct EmbeddedFile {
  const char* name;
  const char* text;
};
extern const EmbeddedFile embedded_files[];
extern const int embedded_file_count;
extern const EmbeddedFile embedded_examples[];
extern const int embedded_example_count;

} // namespace cdem::script
