// cdem sweep: a script with every combination of values, as processes side by side. Each run has its folder
// below the sweep's; sweep.csv gathers the figures of their reports, one row a run.
#include "apps/cdem/commands/script_run.hpp"
#include "apps/cdem/commands/sweep_charts.hpp"
#include "apps/cdem/commands/sweep_plan.hpp"
#include "apps/cdem/process/build_info.hpp"
#include "apps/cdem/process/failure.hpp"
#include "apps/cdem/process/interrupt.hpp"
#include "apps/cdem/process/memory.hpp"
#include "apps/cdem/progress/sweep_view.hpp"
#include "apps/cdem/results/records.hpp"
#include "apps/cdem/results/run_log.hpp"
#include "apps/cdem/text/text.hpp"
#include "libcdem/step/errors.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/plain_reason.hpp"
#include "lua/binding/files/files.hpp"
#include "lua/binding/files/process_pool.hpp"
#include "lua/binding/files/sources.hpp"
#include "lua/binding/text/csv.hpp"
#include "lua/binding/text/nearest.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <set>

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> run_arguments(const SweepCommand& command, const SweptRun& run, int threads,
                                       std::size_t memory, const fs::path& sources) {
  std::vector<std::string> words = {program_path().string(),
                                    "run",
                                    command.script.string(),
                                    "--machine-progress",
                                    "--threads",
                                    std::to_string(threads),
                                    "--output",
                                    run.folder.string(),
                                    "--sources",
                                    sources.string(),
                                    "--memory",
                                    std::to_string(memory)};
  if (command.unsafe)
    words.push_back("--unsafe");
  for (const auto& [name, value] : run.set) {
    words.push_back("--set");
    words.push_back(name + "=" + value);
  }
  return words;
}

std::string last_line(const fs::path& file) {
  std::ifstream in(file);
  std::string last;
  for (std::string line; std::getline(in, line);)
    last = line;
  return last;
}

std::string verdict_of(const SweptRun& run) {
  if (run.exit_code == 0) {
    const int warnings = summary_of_run_log(run.folder / run_log_name).warnings;
    return warnings == 0 ? "done" : "done with " + geom::counted(warnings, "warning");
  }
  const std::string front = "cdem: error: ", line = last_line(run.console);
  return "exit code " + std::to_string(run.exit_code) +
         (line.rfind(front, 0) == 0 ? ", " + line.substr(front.size()) : std::string());
}

// The exit code of the whole: the worst that a run shows, in the order of the codes.
ExitCode judge(const std::vector<SweptRun>& runs) {
  int worst = 0;
  for (const auto& run : runs)
    worst = std::max(worst, run.exit_code);
  return static_cast<ExitCode>(worst > 4 ? 1 : worst);
}

// After Ctrl-C: what stands, and what can be done with the rest.
std::vector<std::string> what_stands(const SweepCommand& command, const std::vector<SweptRun>& runs,
                                     const fs::path& table) {
  std::size_t ended = 0, rest = 0;
  std::vector<std::string> lines;
  for (const auto& run : runs)
    if (run.ended)
      ++ended;
    else if (run.begun && has_checkpoint(run))
      lines.push_back(shown(run.set) +
                      ": stopped; to go on: " + script::resume_command(run.folder, command.unsafe));
    else
      ++rest;
  lines.insert(lines.begin(), std::to_string(ended) + " of " + number_of_runs(runs.size()) +
                                  (ended == 1 ? " had ended and stands" : " had ended and stand") +
                                  "; table in " + table.string());
  if (rest > 0)
    lines.push_back(
        number_of_runs(rest) + (rest == 1 ? " has" : " have") +
        " nothing to go on from: cdem sweep with their values and another --output runs them anew");
  return lines;
}

} // namespace

ExitCode sweep(const SweepCommand& command) {
  require_script(command.script);
  const int cores = available_cores();
  const int jobs =
      std::min(command.jobs > 0 ? command.jobs : cores, static_cast<int>(command.settings.size()));
  const int threads = command.threads > 0 ? command.threads : std::max(1, cores / jobs);
  const std::size_t memory =
      std::max(least_memory, limit_memory(command.memory) / static_cast<std::size_t>(jobs));
  const fs::path root = sweep_folder(command);
  auto runs = planned_runs(command, root);
  OutputFolder folder(root, command.script, "cdem " + version() + " (" + build_text() + "), " + command.line);
  folder.begin_results();
  keep_sources(command.script, folder);
  std::vector<script::Job> processes(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    processes[i].command = run_arguments(command, runs[i], threads, memory, root / script::sources_folder);
    processes[i].console = runs[i].console;
    std::error_code none;
    fs::remove(runs[i].console, none); // of a sweep that was killed; once it is there the run has started
  }

  SweepView view(runs.size(), command.quiet);
  const auto say = [&](const std::string& line) {
    view.message(line);
    folder.log(line);
  };
  say(number_of_runs(runs.size()) + ", " + std::to_string(jobs) + " side by side, " +
      geom::counted(threads, "thread") + " each");
  const auto ended = [&](const script::Job& process) {
    const auto index = static_cast<std::size_t>(&process - processes.data());
    SweptRun& run = runs[index];
    run.ended = true;
    run.exit_code = process.exit_code;
    run.seconds = process.seconds;
    view.ended(index);
    say(shown(run.set) + ": " + verdict_of(run) + ", " + duration_text(run.seconds));
    std::error_code none;
    fs::remove(run.console, none);
  };
  // Asked some times a second: the moment to look at what the runs print.
  const auto stop = [&] {
    if (view.is_due()) {
      for (std::size_t i = 0; i < runs.size(); ++i)
        if (!runs[i].ended && fs::exists(runs[i].console))
          view.progress(i, shown(runs[i].set), last_line(runs[i].console));
      view.draw();
    }
    return interrupt::requested();
  };
  interrupt::doing(Activity::stage); // the runs save what they have when they are stopped
  script::run_jobs(processes, jobs, stop, ended);
  interrupt::doing(Activity::saving);
  view.clear();
  for (auto& run : runs) {
    std::error_code none;
    run.begun = fs::remove(run.console, none) || run.ended;
  }

  const fs::path table = root / "sweep.csv";
  folder.will_write(table);
  const std::vector<SweptFigures> figures = figures_of(runs);
  write_table(runs, figures, table);
  if (interrupt::requested()) {
    for (const auto& line : what_stands(command, runs, table))
      say(line);
    folder.finish(interrupt::exit_code(), "stopped by the user");
    throw Interrupted();
  }
  const auto failed =
      std::count_if(runs.begin(), runs.end(), [](const SweptRun& run) { return run.exit_code != 0; });
  const ExitCode code = judge(runs);
  say("table in " + table.string());
  try {
    const auto charts = draw_sweep(figures, root, [&](const fs::path& file) { folder.will_write(file); });
    if (!charts.empty())
      say((charts.size() == 1 ? "chart: " : "charts: ") + script::joined(charts, " "));
  } catch (const std::exception& error) { // the table stands
    say(std::string("no charts: ") + geom::plain_reason(error));
  }
  const std::string verdict = std::to_string(failed) + " of " + std::to_string(runs.size()) +
                              " runs failed; see " + (root / run_log_name).string();
  folder.finish(code, failed > 0 ? verdict : "");
  if (failed > 0)
    print_failure({code, verdict, ""});
  return code;
}

} // namespace cdem::app
