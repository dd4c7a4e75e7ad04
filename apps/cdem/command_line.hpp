// The command line: which command with which options. The only place that sees the parser library.
#pragma once

#include "apps/cdem/process/exit_code.hpp"

#include <functional>

namespace cdem::app {

// What is to be done. Throws UsageError, naming the nearest right command or option.
std::function<ExitCode()> parse_command_line(int argc, const char* const* argv);

} // namespace cdem::app
