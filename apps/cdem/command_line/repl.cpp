#include "apps/cdem/command_line/common_options.hpp"
#include "apps/cdem/commands/commands.hpp"

#include <memory>

namespace cdem::app {

namespace {

struct TypedRepl {
  std::string threads, memory;
  bool unsafe = false;
};

} // namespace

Command repl_command() {
  const auto typed = std::make_shared<TypedRepl>();
  Command command("repl", "type Lua with the cdem module at hand");
  add_threads(command, typed->threads, "threads (every core)");
  add_memory(command, typed->memory);
  command.flag("--unsafe", typed->unsafe, "all of Lua and any file");
  command.examples =
      "  cdem repl\n  echo 'print(cdem.grid{ size = {1, 1, 1}, divisions = {2, 2, 2} })' | cdem repl\n";
  command.action = [typed, name = command.name](const TypedLine&) -> Action {
    refuse_ranks(name);
    const ReplCommand c{threads_of(typed->threads), typed->unsafe, memory_of(typed->memory)};
    return [c] { return repl(c); };
  };
  return command;
}

} // namespace cdem::app
