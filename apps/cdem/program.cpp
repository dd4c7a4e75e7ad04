#include "apps/cdem/program.hpp"

#include "apps/cdem/command_line.hpp"
#include "apps/cdem/failure.hpp"
#include "apps/cdem/interrupt.hpp"
#include "libcdem/parallel/instruction_set.hpp"

namespace cdem::app {

int run_program(int argc, char** argv) {
  interrupt::install();
  try {
    (void)instruction_set(); // what the environment asks for is told of at once
    return to_int(parse_command_line(argc, argv)());
  } catch (...) {
    const Failure failure = current_failure();
    print_failure(failure);
    return to_int(failure.code);
  }
}

} // namespace cdem::app
