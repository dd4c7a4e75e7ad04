#include "apps/cdem/process/exit_code.hpp"

namespace cdem::app {

std::string exit_code_table() {
  return "  0    success\n"
         "  1    internal error: something cdem did not foresee\n"
         "  2    wrong command line, script or input\n"
         "  3    the solution failed: NaN, an inverted element, a run-away displacement\n"
         "  4    a file cannot be read or written\n"
         "  5    ./cdem only: packages, configuration or build failed\n"
         "  6    one of several ranks was killed, and all have ended\n"
         "  130  stopped by Ctrl-C\n"
         "  143  stopped by SIGTERM\n";
}

} // namespace cdem::app
