// cdem resume: the same run again, from the newest of its checkpoints on.
#include "apps/cdem/commands/script_run.hpp"
#include "apps/cdem/process/failure.hpp"
#include "apps/cdem/results/run_log.hpp"
#include "lua/binding/files/files.hpp"
#include "lua/binding/replay/led.hpp"

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

// What the folder tells of the run, and where to go on from.
RunCommand run_of(const ResumeCommand& command) {
  std::error_code none;
  if (!is_there(command.folder))
    throw script::FileError(command.folder.string() + ": no such folder");
  if (!fs::is_directory(command.folder, none))
    throw UsageError(command.folder.string() + " is not a folder; give the output folder of the run");
  if (!is_run_log(command.folder / run_log_name))
    throw UsageError(command.folder.string() + " is not the output folder of a run: it has no " +
                     run_log_name);
  const script::CheckpointInfo checkpoint =
      script::newest_checkpoint(command.folder, run_of_log(command.folder / run_log_name));
  if (checkpoint.unsafe && !command.unsafe)
    throw UsageError(command.folder.string() +
                     ": the run was started with --unsafe; if its script can be trusted say so again: " +
                     script::resume_command(command.folder, true));
  RunCommand run_on;
  run_on.script = fs::relative(checkpoint.script, fs::current_path(), none);
  if (none || *run_on.script.begin() == "..")
    run_on.script = checkpoint.script;
  run_on.set = checkpoint.set;
  run_on.resume = checkpoint.file;
  return run_on;
}

} // namespace

ExitCode resume(const ResumeCommand& command) {
  RunCommand run_on;
  static_cast<SolvingCommand&>(run_on) = command;
  const script::Value told = script::led("the folder of the run", [&]() -> script::Value {
    const RunCommand found = run_of(command);
    script::Table set;
    for (const auto& [name, value] : found.set)
      set.named[name] = value;
    return script::Table{{"script", found.script.string()}, {"resume", found.resume.string()}, {"set", set}};
  });
  const auto& known = told.table()->named;
  run_on.script = *known.at("script").get<std::string>();
  run_on.resume = *known.at("resume").get<std::string>();
  for (const auto& [name, value] : known.at("set").table()->named)
    run_on.set[name] = *value.get<std::string>();
  run_on.output = command.folder;
  return run(run_on);
}

} // namespace cdem::app
