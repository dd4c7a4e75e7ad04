// The Lua side of the module (lua/cdem/*.lua), put into the program by CMake.
#pragma once

namespace cdem::script {

struct EmbeddedFile {
  const char* name;
  const char* text;
};
extern const EmbeddedFile embedded_files[];
extern const int embedded_file_count;

} // namespace cdem::script
