#include "apps/cdem/command_line/common_options.hpp"
#include "apps/cdem/command_line/option_values.hpp"
#include "apps/cdem/commands/commands.hpp"
#include "apps/cdem/process/failure.hpp"

#include <memory>

namespace cdem::app {

namespace {

constexpr int most_points = 100000;

struct TypedSweep {
  std::string file, jobs, threads, memory, output, ranks, point;
  std::vector<std::string> set;
  bool unsafe = false, slurm = false, quiet = false;
};

} // namespace

Command sweep_command() {
  const auto typed = std::make_shared<TypedSweep>();
  Command command("sweep", "run a script with every combination of values, side by side");
  add_script(command, typed->file);
  add_unsafe(command, typed->unsafe);
  add_set(command, typed->set, "NAME=A,B,...", "values of a parameter of the script; may be repeated");
  command.value("--jobs,-j", typed->jobs, "N", "runs side by side (one a core)");
  add_threads(command, typed->threads, "threads of each run (the cores shared among the jobs)");
  add_memory(command, typed->memory);
  add_output(command, typed->output, "DIR",
             "folder for the runs, sweep.csv and charts of it (results/<case>-sweep)");
  command.flag("--slurm", typed->slurm, "run nothing; write DIR/sweep.sbatch, a job array for sbatch");
  command.value("--ranks", typed->ranks, "N", "with --slurm: processes that solve each run together (1)");
  command.value("--point", typed->point, "", "the run that a task of the array is for");
  command.hide_last();
  add_quiet(command, typed->quiet);
  command.examples = "  cdem sweep case.lua --set pressure=20e6,25e6,30e6 --set cohesion=5e6,8e6 --jobs 2\n";
  command.notes =
      "All runs use the script, and the files that it requires by a name in quotes, as they are when the\n"
      "sweep begins; the folder keeps copies in swept/. Data files are read when a run reads them.\n"
      "\n"
      "--slurm writes a job array. The same command again, when jobs have ended, gathers their figures in\n"
      "sweep.csv and writes an array of the rest: docs/cluster.md.\n";
  command.action = [typed, name = command.name](const TypedLine& line) -> Action {
    require_file(typed->file, name, "FILE.lua --set NAME=A,B,...");
    if (typed->point.empty())
      refuse_ranks(name);
    if (typed->set.empty())
      throw UsageError("cdem sweep: nothing varies; give --set NAME=A,B,...");
    SweepCommand c;
    c.script = typed->file;
    c.output = typed->output;
    c.settings = combinations_of(typed->set);
    c.jobs = typed->jobs.empty() ? 0 : whole_number("--jobs", typed->jobs, 1, most_threads);
    c.threads = threads_of(typed->threads);
    c.memory = memory_of(typed->memory);
    c.unsafe = typed->unsafe;
    c.quiet = typed->quiet;
    c.line = line.text;
    c.sets = typed->set;
    c.ranks = ranks_of(typed->ranks);
    if (!typed->point.empty()) {
      const int point = whole_number("--point", typed->point, 1, most_points);
      return [c, point] { return run_point(c, point); };
    }
    if (typed->slurm)
      return [c] { return write_job_array(c); };
    if (c.ranks > 1)
      throw UsageError("cdem sweep: --ranks goes with --slurm; here the runs stand side by side (--jobs)");
    return [c] { return sweep(c); };
  };
  return command;
}

} // namespace cdem::app
