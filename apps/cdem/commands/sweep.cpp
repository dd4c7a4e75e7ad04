// cdem sweep: a script with every combination of values, as processes side by side. Each run has its folder
// below the sweep's; sweep.csv gathers the figures of their reports, one row a run.
#include "apps/cdem/build_info.hpp"
#include "apps/cdem/commands/script_run.hpp"
#include "apps/cdem/commands/sweep_charts.hpp"
#include "apps/cdem/failure.hpp"
#include "apps/cdem/interrupt.hpp"
#include "apps/cdem/memory.hpp"
#include "apps/cdem/progress/sweep_view.hpp"
#include "apps/cdem/records.hpp"
#include "apps/cdem/run_log.hpp"
#include "apps/cdem/text.hpp"
#include "libcdem/step/errors.hpp"
#include "lua/binding/runtime/csv.hpp"
#include "lua/binding/runtime/files.hpp"
#include "lua/binding/runtime/process_pool.hpp"
#include "lua/binding/runtime/sources.hpp"
#include "lua/binding/schema/nearest.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <set>

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

struct SweptRun {
  Settings set;
  std::string name; // "pressure=24e6,cohesion=5e6", also its folder
  fs::path folder;  // its results
  fs::path console; // what it prints: its progress, then its error
  bool begun = false, ended = false;
  int exit_code = -1; // not run
  double seconds = 0; // wall clock
};

// Folder name of a run: as case_name makes it of its settings alone.
std::string run_name(const Settings& set) {
  const std::string whole = case_name("/x/case.lua", set);
  return whole.substr(whole.find('-') + 1);
}

std::string shown(const Settings& set) {
  std::vector<std::string> words;
  for (const auto& [name, value] : set)
    words.push_back(name + "=" + value);
  return script::joined(words, " ");
}

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

std::vector<SweptFigures> figures_of(const std::vector<SweptRun>& runs) {
  std::vector<SweptFigures> all;
  for (const SweptRun& run : runs) {
    const fs::path report = run.folder / "report.json";
    // What a failed run has in its folder may be of an earlier sweep.
    const bool there = run.exit_code == 0 && fs::exists(report);
    all.push_back({run.set, there ? read_report(report) : std::vector<Figure>()});
  }
  return all;
}

// Columns: the settings, exit code, wall time, then every figure that any report has, by name.
void write_table(const std::vector<SweptRun>& runs, const std::vector<SweptFigures>& figures,
                 const fs::path& file) {
  std::vector<std::map<std::string, std::string>> values(runs.size());
  std::vector<std::string> names; // in order of appearance
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (const auto& figure : figures[i].figures) {
      values[i][figure.name] = figure.value;
      if (std::find(names.begin(), names.end(), figure.name) == names.end())
        names.push_back(figure.name);
    }
  }
  std::ofstream out(file);
  for (const auto& [name, value] : runs.front().set)
    out << script::csv_cell(name) << ',';
  out << "exit_code,wall_time_s";
  for (const auto& name : names)
    out << ',' << script::csv_cell(name);
  out << '\n';
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (const auto& [name, value] : runs[i].set)
      out << script::csv_cell(value) << ',';
    out << (runs[i].exit_code < 0 ? "" : std::to_string(runs[i].exit_code)) << ','
        << number_text(runs[i].seconds);
    for (const auto& name : names)
      out << ',' << script::csv_cell(values[i][name]);
    out << '\n';
  }
  if (!out.flush())
    throw script::FileError(file.string() + " cannot be written");
}

std::vector<SweptRun> planned_runs(const SweepCommand& command, const fs::path& folder) {
  std::vector<SweptRun> runs;
  std::set<std::string> names;
  for (const auto& set : command.settings) {
    SweptRun run;
    run.set = set;
    run.name = run_name(set);
    run.folder = folder / run.name;
    run.console = folder / (run.name + ".console");
    if (!names.insert(run.name).second)
      throw UsageError("--set gives the same run twice: " + shown(set));
    runs.push_back(run);
  }
  return runs;
}

std::string verdict_of(const SweptRun& run) {
  if (run.exit_code == 0) {
    const int warnings = summary_of_run_log(run.folder / run_log_name).warnings;
    return warnings == 0
               ? "done"
               : "done with " + std::to_string(warnings) + (warnings == 1 ? " warning" : " warnings");
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

bool has_checkpoint(const SweptRun& run) {
  try {
    script::newest_checkpoint(run.folder, run_of_log(run.folder / run_log_name));
    return true;
  } catch (const script::FileError&) {
    return false;
  }
}

std::string number_of_runs(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " run" : " runs");
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
  const fs::path root = command.output.empty()
                            ? fs::path("results") / (case_name(command.script, {}) + "-sweep")
                            : command.output;

  auto runs = planned_runs(command, root);
  OutputFolder folder(root, command.script, "cdem " + version() + " (" + build_text() + "), " + command.line);
  folder.begin_results();
  script::each_source(command.script, [&](const fs::path& name, const std::string& text) {
    const fs::path copy = root / script::sources_folder / name;
    folder.will_write(copy);
    fs::create_directories(copy.parent_path());
    script::write_file(copy, text);
  });
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
      std::to_string(threads) + (threads == 1 ? " thread" : " threads") + " each");
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
    say(std::string("no charts: ") + error.what());
  }
  const std::string verdict = std::to_string(failed) + " of " + std::to_string(runs.size()) +
                              " runs failed; see " + (root / run_log_name).string();
  folder.finish(code, failed > 0 ? verdict : "");
  if (failed > 0)
    print_failure({code, verdict, ""});
  return code;
}

} // namespace cdem::app
