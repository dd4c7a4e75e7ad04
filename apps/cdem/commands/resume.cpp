// cdem resume: the same run again, from the newest of its checkpoints on.
#include "apps/cdem/commands/script_run.hpp"
#include "apps/cdem/failure.hpp"
#include "apps/cdem/run_log.hpp"
#include "lua/binding/runtime/files.hpp"

namespace cdem::app {

namespace fs = std::filesystem;

ExitCode resume(const ResumeCommand& command) {
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
  run_on.output = command.folder;
  run_on.threads = command.threads;
  run_on.memory = command.memory;
  run_on.set = checkpoint.set;
  run_on.unsafe = command.unsafe;
  run_on.progress = command.progress;
  run_on.checkpoint_minutes = command.checkpoint_minutes;
  run_on.resume = checkpoint.file;
  run_on.live = command.live;
  run_on.line = command.line;
  return run(run_on);
}

} // namespace cdem::app
