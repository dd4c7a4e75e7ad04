// How the program ends; docs/exit-codes.md is the user's copy.
#pragma once

#include <string>

namespace cdem::app {

enum class ExitCode : int {
  success = 0,
  internal_error = 1,  // something cdem did not foresee: a bug
  bad_input = 2,       // command line, script or input
  solution_failed = 3, // NaN, inverted element, run-away displacement
  file_error = 4,
  setup_failed = 5, // the launcher's own
  rank_lost = 6,    // of several that solve together, killed from outside
  interrupted = 130,
  terminated = 143,
};

inline int to_int(ExitCode code) {
  return static_cast<int>(code);
}

// The table of --help, one line a code.
std::string exit_code_table();

} // namespace cdem::app
