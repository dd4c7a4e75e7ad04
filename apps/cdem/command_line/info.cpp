#include "apps/cdem/command_line/common_options.hpp"
#include "apps/cdem/commands/commands.hpp"

#include <memory>

namespace cdem::app {

namespace {

struct TypedInfo {
  std::string path;
};

} // namespace

Command info_command() {
  const auto typed = std::make_shared<TypedInfo>();
  Command command("info", "describe this program, a saved file, a script or a results folder");
  command.argument("PATH", typed->path,
                   "a .vtu, .pvtu or .vtkhdf file, a .lua script or a folder of results; none: this program");
  command.examples = "  cdem info\n  cdem info case.lua\n  cdem info results/plate\n";
  command.action = [typed](const TypedLine&) -> Action {
    return [path = typed->path] { return info(path); };
  };
  return command;
}

} // namespace cdem::app
