#include "apps/cdem/command_line/common_options.hpp"
#include "apps/cdem/commands/commands.hpp"

#include <memory>

namespace cdem::app {

namespace {

struct TypedView {
  std::string path;
};

} // namespace

Command view_command() {
  const auto typed = std::make_shared<TypedView>();
  Command command("view", "look at saved files in a browser page of this machine");
  command.argument("PATH", typed->path,
                   "a .vtu, .pvtu or .vtkhdf file, a .pvd series or a folder of results");
  command.examples = "  cdem view results/plate\n  cdem view results/plate/run.pvd\n";
  command.notes =
      "Prints the address of a page that shows the model: choose the file, the field and the step, turn\n"
      "and zoom it, play a series. cdem draws each picture, so the browser may be a plain one. The page\n"
      "can be read on this machine only; its button, or Ctrl-C, ends the viewer.\n";
  command.action = [typed, name = command.name](const TypedLine&) -> Action {
    refuse_ranks(name);
    require_file(typed->path, name, "PATH");
    return [path = typed->path] { return view(path); };
  };
  return command;
}

} // namespace cdem::app
