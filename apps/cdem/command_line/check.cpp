#include "apps/cdem/command_line/common_options.hpp"
#include "apps/cdem/command_line/option_values.hpp"
#include "apps/cdem/commands/commands.hpp"

#include <memory>

namespace cdem::app {

namespace {

struct TypedCheck {
  std::string file, threads, memory;
  std::vector<std::string> set;
  bool unsafe = false;
};

} // namespace

Command check_command() {
  const auto typed = std::make_shared<TypedCheck>();
  Command command("check", "build and validate what a script describes, without solving");
  add_script(command, typed->file);
  add_unsafe(command, typed->unsafe);
  add_threads(command, typed->threads, "threads (every core)");
  add_memory(command, typed->memory);
  add_set(command, typed->set, "NAME=VALUE", "value of a parameter of the script; may be repeated");
  command.examples = "  cdem check case.lua --set pressure=24e6\n";
  command.notes =
      "Prints the parameters, the parts of each model, its box from corner to corner, conditions and\n"
      "stages. Solving calls call their callbacks once and return empty results; what the script prints\n"
      "after the first of them is left out. No file is written.\n";
  command.action = [typed, name = command.name](const TypedLine&) -> Action {
    require_file(typed->file, name, "FILE.lua");
    const CheckCommand c{typed->file, threads_of(typed->threads), settings_of(typed->set), typed->unsafe,
                         memory_of(typed->memory)};
    return [c] { return check(c); };
  };
  return command;
}

} // namespace cdem::app
