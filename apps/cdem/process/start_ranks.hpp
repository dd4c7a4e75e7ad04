// --ranks N: this program again as N ranks on this machine, by mpirun.
#pragma once

#include "apps/cdem/process/exit_code.hpp"

#include <string>
#include <vector>

namespace cdem::app {

constexpr int most_ranks = 4096;

// words: of the command line behind the program, without --ranks. Gives back what rank 0 ends with. Throws UsageError
// where ranks cannot be started.
ExitCode start_ranks(int count, const std::vector<std::string>& words);

} // namespace cdem::app
