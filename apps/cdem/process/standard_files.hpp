// The terminal of who calls `cdem run --ranks`, for rank 0: mpirun would hand it pipes, in which no progress line lives. The
// starter waits at a socket of its own user, and sends its standard input, output and error through it.
#pragma once

#include <string>

namespace cdem::app {

constexpr const char* starter_variable =
    "CDEM_RANKS_STARTER"; // name of the socket, in the environment of the ranks

// Rank 0: takes those of the starter for its own. Gives back the socket, through which it tells its exit code at the end,
// or -1 where nobody waits.
int take_standard_files();

class StandardFiles {
public:
  StandardFiles(); // waits from now on, by starter_variable
  ~StandardFiles();
  StandardFiles(const StandardFiles&) = delete;
  StandardFiles& operator=(const StandardFiles&) = delete;

  void look();                                 // gives them to rank 0 when it asks, and hears what it tells
  int rank_0() const { return process_; }      // 0: it has not asked yet
  int exit_code() const { return exit_code_; } // that rank 0 has told; -1: none

private:
  void give();

  int waiting_ = -1, connected_ = -1, exit_code_ = -1;
  int process_ = 0;
};

} // namespace cdem::app
