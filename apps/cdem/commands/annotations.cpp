// cdem annotations: what an editor needs to complete and check scripts.
#include "apps/cdem/commands/commands.hpp"
#include "lua/binding/module/topics.hpp"

#include <cstdio>

namespace cdem::app {

ExitCode print_annotations() {
  std::fputs(script::annotations().c_str(), stdout);
  return ExitCode::success;
}

} // namespace cdem::app
