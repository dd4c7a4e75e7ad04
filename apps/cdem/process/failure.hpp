// What went wrong, as one line for the user and an exit code for the shell.
#pragma once

#include "apps/cdem/process/exit_code.hpp"

#include <stdexcept>
#include <string>

namespace cdem::app {

// The command line asks for something that cannot be done.
class UsageError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

// A rank has gone, as by kill -9 or for want of memory, and the others with it.
class RankLost : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

inline constexpr const char* not_enough_memory =
    "not enough memory: the model is too large for this machine, or for what --memory allows";

struct Failure {
  ExitCode code = ExitCode::internal_error;
  std::string line;    // one line, without "cdem: error: "
  std::string details; // the whole message when it has more lines than one, for the log
};

// Judges the exception in flight: call it from a catch block only.
Failure current_failure();

// "cdem: error: ..." on stderr.
void print_failure(const Failure&);

} // namespace cdem::app
