// cdem sweep --slurm: the runs of a sweep as a job array for sbatch, one task a run. The same command again gathers what
// has ended, and writes an array of the rest.
#include "apps/cdem/commands/script_run.hpp"
#include "apps/cdem/commands/sweep_plan.hpp"
#include "apps/cdem/process/build_info.hpp"
#include "apps/cdem/process/failure.hpp"
#include "apps/cdem/results/run_log.hpp"
#include "apps/cdem/text/quoted.hpp"
#include "lua/binding/files/files.hpp"
#include "lua/binding/files/sources.hpp"
#include "lua/binding/replay/led.hpp"

#include <algorithm>
#include <cstdio>

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

constexpr int seconds_to_save = 300; // between SIGTERM and the end of the time that Slurm has granted

bool has_ended(const SweptRun& run) {
  std::error_code none;
  const fs::path log = run.folder / run_log_name;
  return fs::exists(log, none) && is_run_log(log) && summary_of_run_log(log).exit_code == 0;
}

// Whole numbers from 1 as sbatch takes them: "1,3-6".
std::string ranges(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1)
      ++last;
    text += (text.empty() ? "" : ",") + std::to_string(numbers[i]);
    if (last > i)
      text += "-" + std::to_string(numbers[last]);
    i = last;
  }
  return text;
}

// The text that runs which have ended have run must be that of the others.
void require_same_sources(const SweepCommand& command, const fs::path& root) {
  script::each_source(command.script, [&](const fs::path& name, const std::string& text) {
    const fs::path kept = root / script::sources_folder / name;
    std::error_code none;
    if (fs::exists(kept, none) && script::read_file(kept) != text)
      throw UsageError(kept.string() + " is of another text of " + name.string() +
                       "; put it back as it was, or choose another --output");
  });
}

std::string batch_script(const SweepCommand& command, const fs::path& root,
                         const std::vector<std::size_t>& numbers) {
  std::string words;
  for (const std::string& word : command.sets)
    words += " --set " + quoted(word);
  const std::string threads = std::to_string(std::max(1, command.threads)),
                    ranks = std::to_string(command.ranks), folder = fs::absolute(root).string();
  return "#!/bin/sh\n"
         "# Runs of a sweep, one a task. It may be submitted again: what has ended stands, what was stopped "
         "goes on.\n"
         "# What else Slurm shall know, such as --time, --mem and --partition, goes to sbatch or into lines "
         "like these.\n"
         "#SBATCH --job-name=" +
         root.filename().string() + "\n#SBATCH --array=" + ranges(numbers) + "\n#SBATCH --ntasks=" + ranks +
         "\n#SBATCH --cpus-per-task=" + threads + "\n#SBATCH --signal=TERM@" +
         std::to_string(seconds_to_save) + "\n#SBATCH --output=" + folder + "/slurm-%a.txt\ncd " +
         quoted(fs::current_path().string()) + " || exit 4\nexec srun --ntasks=" + ranks +
         (command.ranks > 1 ? " --mpi=pmix " : " ") + quoted(program_path().string()) + " sweep " +
         quoted(command.script.string()) + words + " --output " + quoted(root.string()) + " --threads " +
         threads + (command.unsafe ? " --unsafe" : "") + " --point \"$SLURM_ARRAY_TASK_ID\"\n";
}

} // namespace

ExitCode write_job_array(const SweepCommand& command) {
  require_script(command.script);
  const fs::path root = sweep_folder(command);
  auto runs = planned_runs(command, root);
  const bool goes_on = is_run_log(root / run_log_name);
  if (goes_on)
    require_same_sources(command, root);
  OutputFolder folder(root, command.script, "cdem " + version() + " (" + build_text() + "), " + command.line,
                      goes_on ? OutputFolder::Start::goes_on : OutputFolder::Start::anew);
  folder.begin_results();
  keep_sources(command.script, folder);
  std::vector<std::size_t> rest;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].seconds = -1;
    if (has_ended(runs[i]))
      runs[i].exit_code = 0;
    else
      rest.push_back(i + 1);
  }
  std::string told = number_of_runs(runs.size());
  if (rest.size() < runs.size()) {
    const fs::path table = root / "sweep.csv";
    folder.will_write(table);
    write_table(runs, figures_of(runs), table);
    told +=
        ", " + std::to_string(runs.size() - rest.size()) + " of which have ended; table in " + table.string();
  }
  if (!rest.empty()) {
    const fs::path batch = root / "sweep.sbatch";
    folder.will_write(batch);
    script::write_file(batch, batch_script(command, root, rest));
    told += "; to run " + std::string(rest.size() < runs.size() ? "the rest" : "them") + ": sbatch " +
            batch.string();
  }
  folder.log(told);
  std::printf("%s\n", told.c_str());
  folder.finish(ExitCode::success, "");
  return ExitCode::success;
}

ExitCode run_point(const SweepCommand& command, int point) {
  const fs::path root = sweep_folder(command);
  const auto runs = planned_runs(command, root);
  if (point > static_cast<int>(runs.size()))
    throw UsageError("--point " + std::to_string(point) + ": the sweep has " + number_of_runs(runs.size()));
  const SweptRun& mine = runs[static_cast<std::size_t>(point - 1)];
  RunCommand run_on;
  run_on.script = command.script;
  run_on.sources = root / script::sources_folder;
  run_on.output = mine.folder;
  run_on.threads = command.threads;
  run_on.memory = command.memory;
  run_on.set = mine.set;
  run_on.unsafe = command.unsafe;
  run_on.progress = command.quiet ? ProgressStyle::none : ProgressStyle::plain;
  run_on.line = command.line;
  const script::Value known = script::led("the folder of the run", [&]() -> script::Value {
    if (has_ended(mine))
      return true;
    return has_checkpoint(mine)
               ? script::Value(script::newest_checkpoint(mine.folder, run_of_log(mine.folder / run_log_name))
                                   .file.string())
               : script::Value();
  });
  if (known.get<bool>() != nullptr) {
    std::printf("%s: had ended and stands\n", shown(mine.set).c_str());
    return ExitCode::success;
  }
  if (const auto* checkpoint = known.get<std::string>())
    run_on.resume = *checkpoint;
  return run(run_on);
}

} // namespace cdem::app
