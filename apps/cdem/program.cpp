#include "apps/cdem/program.hpp"

#include "apps/cdem/command_line.hpp"
#include "apps/cdem/process/failure.hpp"
#include "apps/cdem/process/interrupt.hpp"
#include "apps/cdem/process/rank.hpp"
#include "libcdem/parallel/instruction_set.hpp"

#include "lua/binding/runtime/engine.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace cdem::app {

namespace {

// A file that is opened where stdin, stdout or stderr was closed would be taken for it.
void open_standard_files() {
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(file, F_GETFD) < 0)
      open("/dev/null", O_RDWR);
}

// What was printed must have arrived; a reader that has seen enough (`cdem run ... | head`) is no failure.
void require_stdout_written() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)
    return;
  const int reason = errno;
  pollfd pipe{STDOUT_FILENO, POLLOUT, 0};
  if (poll(&pipe, 1, 0) > 0 && (pipe.revents & POLLERR) != 0)
    return;
  throw script::FileError(std::string("standard output cannot be written: ") +
                          (reason != 0 ? std::strerror(reason) : "is the disk full?"));
}

// What is thrown in a parallel loop cannot leave it and ends the program here: memory that is short, as a rule.
[[noreturn]] void end_by_exception() {
  const Failure failure = std::current_exception() ? current_failure() : Failure();
  interrupt::end_now(failure.code, failure.line.empty() ? "internal error, please report it" : failure.line);
}

} // namespace

int run_program(int argc, char** argv) {
  open_standard_files();
  interrupt::install();
  std::set_terminate(end_by_exception);
  try {
    join_other_ranks(argc, argv);
    (void)instruction_set(); // what the environment asks for is told of at once
    const ExitCode code = parse_command_line(argc, argv)();
    require_stdout_written();
    interrupt::finished();
    return leave_other_ranks(to_int(code));
  } catch (...) {
    const Failure failure = failure_of_all(current_failure());
    interrupt::finished();
    print_failure(failure);
    return leave_other_ranks(to_int(failure.code));
  }
}

} // namespace cdem::app
