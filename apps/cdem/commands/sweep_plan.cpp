#include "apps/cdem/commands/sweep_plan.hpp"

#include "apps/cdem/process/failure.hpp"
#include "apps/cdem/results/records.hpp"
#include "apps/cdem/results/run_log.hpp"
#include "apps/cdem/text/text.hpp"
#include "libgeom/core/error.hpp"
#include "lua/binding/files/files.hpp"
#include "lua/binding/files/sources.hpp"
#include "lua/binding/text/csv.hpp"
#include "lua/binding/text/nearest.hpp"

#include <algorithm>
#include <fstream>
#include <set>

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

// Folder name of a run: as case_name makes it of its settings alone.
std::string run_name(const Settings& set) {
  const std::string whole = case_name("/x/case.lua", set);
  return whole.substr(whole.find('-') + 1);
}

} // namespace

fs::path sweep_folder(const SweepCommand& command) {
  return command.output.empty() ? fs::path("results") / (case_name(command.script, {}) + "-sweep")
                                : command.output;
}

std::string shown(const Settings& set) {
  std::vector<std::string> words;
  for (const auto& [name, value] : set)
    words.push_back(name + "=" + value);
  return script::joined(words, " ");
}

std::string number_of_runs(std::size_t count) {
  return geom::counted(count, "run");
}

void keep_sources(const fs::path& script, OutputFolder& folder) {
  script::each_source(script, [&](const fs::path& name, const std::string& text) {
    const fs::path copy = folder.path() / script::sources_folder / name;
    folder.will_write(copy);
    fs::create_directories(copy.parent_path());
    script::write_file(copy, text);
  });
}

bool has_checkpoint(const SweptRun& run) {
  try {
    script::newest_checkpoint(run.folder, run_of_log(run.folder / run_log_name));
    return true;
  } catch (const script::FileError&) {
    return false;
  }
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

std::vector<SweptFigures> figures_of(const std::vector<SweptRun>& runs) {
  std::vector<SweptFigures> all;
  for (const SweptRun& run : runs) {
    SweptFigures one{run.set};
    // What a failed run has in its folder may be of an earlier sweep.
    if (const fs::path report = run.folder / "report.json"; run.exit_code == 0 && fs::exists(report))
      one.figures = read_report(report);
    if (const fs::path settings = run.folder / "settings.json"; run.exit_code == 0 && fs::exists(settings))
      one.parameters = read_parameters(settings);
    all.push_back(std::move(one));
  }
  return all;
}

void write_table(const std::vector<SweptRun>& runs, const std::vector<SweptFigures>& figures,
                 const fs::path& file) {
  std::vector<std::map<std::string, std::string>> values(runs.size());
  std::vector<std::string> names, titles; // in order of appearance
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (const auto& figure : figures[i].figures) {
      values[i][figure.name] = figure.value;
      if (std::find(names.begin(), names.end(), figure.name) == names.end()) {
        names.push_back(figure.name);
        titles.push_back(name_with_unit(figure.name, figure.unit));
      }
    }
  }
  std::ofstream out(file);
  for (const auto& [name, value] : runs.front().set)
    out << script::csv_cell(name_with_unit(name, unit_of_parameter(figures, name))) << ',';
  out << "exit_code,wall_time (s)";
  for (const auto& title : titles)
    out << ',' << script::csv_cell(title);
  out << '\n';
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (const auto& [name, value] : runs[i].set)
      out << script::csv_cell(value) << ',';
    out << (runs[i].exit_code < 0 ? "" : std::to_string(runs[i].exit_code)) << ','
        << (runs[i].seconds < 0 ? "" : number_text(runs[i].seconds));
    for (const auto& name : names)
      out << ',' << script::csv_cell(values[i][name]);
    out << '\n';
  }
  if (!out.flush())
    throw script::FileError(file.string() + " cannot be written");
}

} // namespace cdem::app
