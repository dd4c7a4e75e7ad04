#include "apps/cdem/command_line/common_options.hpp"
#include "apps/cdem/command_line/option_values.hpp"
#include "apps/cdem/commands/commands.hpp"

#include <memory>

namespace cdem::app {

namespace {

struct TypedRun {
  std::string file, output, sources;
  std::vector<std::string> set;
  SolvingOptions solving;
  bool machine = false;
};

} // namespace

Command run_command() {
  const auto typed = std::make_shared<TypedRun>();
  Command command("run", "run a case script");
  add_script(command, typed->file);
  add_unsafe(command, typed->solving.unsafe);
  add_output(command, typed->output, "DIR", "folder for results and log (results/<case>)");
  typed->solving.add_computing(command);
  add_set(command, typed->set, "NAME=VALUE", "value of a parameter of the script; may be repeated");
  typed->solving.add_watching(command);
  command.flag("--machine-progress", typed->machine, "progress for a program that watches this run");
  command.hide_last();
  command.value("--sources", typed->sources, "", "folder with the text of the script that a sweep kept");
  command.hide_last();
  command.examples = "  cdem run examples/uniaxial_compression/case.lua\n"
                     "  cdem run case.lua --set pressure=24e6 --output results/gentle\n";
  command.notes =
      "<case> is the name of the script's folder, with -SCRIPT unless it is case.lua, and with the\n"
      "settings: --set pressure=24e6 gives results/uniaxial_compression-pressure=24e6, several are\n"
      "joined by commas in the order of their names. Other characters than letters, digits and +-=.,_\n"
      "become _, and then a short hash keeps cases apart.\n"
      "\n"
      "Once a run writes its first result, it deletes the files of the last run in the same folder. A\n"
      "file that was edited since is kept as FILE.edited. A folder that holds other files than results\n"
      "is refused. Ctrl-C ends a run at the next step, saves the state and writes a checkpoint for cdem\n"
      "resume; a second Ctrl-C ends it at once.\n";
  command.action = [typed, name = command.name](const TypedLine& line) -> Action {
    require_file(typed->file, name, "FILE.lua");
    RunCommand c;
    static_cast<SolvingCommand&>(c) = typed->solving.command(line);
    c.script = typed->file;
    c.sources = typed->sources;
    c.ends_with_parent = !typed->sources.empty();
    c.output = typed->output;
    c.set = settings_of(typed->set);
    if (typed->machine)
      c.progress = ProgressStyle::machine;
    return typed->solving.among_ranks([c] { return run(c); }, line);
  };
  return command;
}

} // namespace cdem::app
