// The runs of a sweep: their settings, folders and table, shared by what runs them here and what writes them for Slurm.
#pragma once

#include "apps/cdem/commands/commands.hpp"
#include "apps/cdem/commands/sweep_charts.hpp"

namespace cdem::app {

struct SweptRun {
  Settings set;
  std::string name;              // "pressure=24e6,cohesion=5e6", also its folder
  std::filesystem::path folder;  // its results
  std::filesystem::path console; // what it prints: its progress, then its error
  bool begun = false, ended = false;
  int exit_code = -1; // not run
  double seconds = 0; // wall clock; negative: not known
};

std::filesystem::path sweep_folder(const SweepCommand&);
std::vector<SweptRun> planned_runs(const SweepCommand&, const std::filesystem::path& folder); // UsageError

std::string shown(const Settings&);            // "pressure=24e6 cohesion=5e6"
std::string number_of_runs(std::size_t count); // "1 run", "12 runs"

// The text that all of them run, into the folder.
void keep_sources(const std::filesystem::path& script, OutputFolder&);

bool has_checkpoint(const SweptRun&);

std::vector<SweptFigures> figures_of(const std::vector<SweptRun>&); // none of runs that failed

// Columns: the settings, exit code, wall time, then every figure that any report has, by name, with their units. FileError.
void write_table(const std::vector<SweptRun>&, const std::vector<SweptFigures>&,
                 const std::filesystem::path& file);

} // namespace cdem::app
