#include "apps/cdem/command_line/common_options.hpp"
#include "apps/cdem/commands/commands.hpp"

#include <memory>

namespace cdem::app {

namespace {

struct TypedResume {
  std::string folder;
  SolvingOptions solving;
};

} // namespace

Command resume_command() {
  const auto typed = std::make_shared<TypedResume>();
  Command command("resume", "continue a run that was stopped or killed");
  command.argument("FOLDER", typed->folder, "its output folder");
  add_unsafe(command, typed->solving.unsafe);
  typed->solving.add_computing(command);
  typed->solving.add_watching(command);
  command.examples = "  cdem resume results/uniaxial_compression\n  cdem resume results/plate --threads 8\n";
  command.notes =
      "Continues from the newest intact checkpoint in the folder, with the script and the settings of the\n"
      "run. The result is the same, bit for bit, as that of a run that was never stopped. The script runs\n"
      "from its beginning; calls before the checkpoint return their recorded results and do nothing. So\n"
      "the script must not have changed. There is one exception, a run that ended with an error of its\n"
      "script (exit code 2 or 4): correct the script; it may change after the last solved stage, or in\n"
      "the callback that failed. A run that was started with --unsafe needs it again. A run that ends\n"
      "well deletes its checkpoints.\n";
  command.action = [typed, name = command.name](const TypedLine& line) -> Action {
    require_file(typed->folder, name, "FOLDER");
    ResumeCommand c;
    static_cast<SolvingCommand&>(c) = typed->solving.command(line);
    c.folder = typed->folder;
    return typed->solving.among_ranks([c] { return resume(c); }, line);
  };
  return command;
}

} // namespace cdem::app
