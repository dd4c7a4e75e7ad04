// What a script can end with.
#pragma once

#include "libcdem/vtk/file_error.hpp"

#include <stdexcept>

namespace cdem::script {

// An error in the script or its input, with "file:line: " in front. Exit code 2.
class ScriptError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

using cdem::FileError; // a file could not be read or written; exit code 4

} // namespace cdem::script
