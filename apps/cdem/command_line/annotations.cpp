#include "apps/cdem/command_line/command.hpp"
#include "apps/cdem/commands/commands.hpp"

namespace cdem::app {

Command annotations_command() {
  Command command("annotations", "print LuaCATS annotations of the cdem module, for editors");
  command.examples = "  cdem annotations > cdem.lua\n";
  command.action = [](const TypedLine&) -> Action { return print_annotations; };
  return command;
}

} // namespace cdem::app
