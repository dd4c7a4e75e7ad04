// cdem info: what this program is, or what a saved file, a script or an output folder holds.
#include "apps/cdem/commands/script_run.hpp"
#include "apps/cdem/live/saved_files.hpp"
#include "apps/cdem/process/build_info.hpp"
#include "apps/cdem/process/failure.hpp"
#include "apps/cdem/results/records.hpp"
#include "apps/cdem/results/run_log.hpp"
#include "apps/cdem/text/text.hpp"
#include "libcdem/parallel/instruction_set.hpp"
#include "libcdem/ranks/ranks.hpp"
#include "libcdem/vtk/files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>

namespace cdem::app {

namespace fs = std::filesystem;

namespace {

using Rows = std::vector<std::vector<std::string>>;

void print_rows(const Rows& rows) {
  std::fputs(table_text(rows).c_str(), stdout);
}

// "model name" of /proc/cpuinfo, and those of its flags the solver's speed depends on.
std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  std::string name, found;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("model name", 0) == 0 && name.empty())
      name = line.substr(line.find(':') + 2);
    if (line.rfind("flags", 0) != 0)
      continue;
    std::istringstream flags(line);
    for (std::string flag; flags >> flag;)
      if (flag == "avx2" || flag == "fma" || flag == "avx512f")
        found += (found.empty() ? "" : ", ") + flag;
    break;
  }
  return (name.empty() ? "unknown" : name) + (found.empty() ? "" : " (" + found + ")");
}

void about_program() {
  const int cores = available_cores();
  print_rows({{"version", version()},
              {"build", build_text()},
              {"program", program_path().string()},
              {"processor", processor()},
              {"instruction set", name(instruction_set()) + " unless CDEM_INSTRUCTION_SET says otherwise"},
              {"threads", std::to_string(cores) + " unless --threads says otherwise"},
              {"ranks", module_of_ranks().empty() ? "1: built without MPI (libopenmpi-dev)"
                                                  : "1 unless --ranks, mpirun or srun says otherwise"}});
  std::printf("\nexit codes\n%s", exit_code_table().c_str());
}

// Names behind the point, as --colour takes them.
std::vector<std::string> component_names(const SnapshotField& field) {
  if (field.components == 6)
    return {"xx", "yy", "zz", "xy", "yz", "xz"};
  if (field.components == 3 && field.name.rfind("principal", 0) == 0)
    return {"1", "2", "3"};
  return {"x", "y", "z"};
}

void add_range(Rows& rows, const std::string& where, const SnapshotField& field, const std::string& name,
               const std::function<double(const double*)>& value_of) {
  const auto n = static_cast<std::size_t>(std::max(field.components, 1));
  double low = INFINITY, high = -INFINITY;
  for (std::size_t i = 0; i + n <= field.values.size(); i += n) {
    const double value = value_of(&field.values[i]);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const bool empty = field.values.size() < n;
  rows.push_back({where, name, field.unit, empty ? "" : number_text(low), empty ? "" : number_text(high)});
}

void add_ranges(Rows& rows, const std::string& where, const std::vector<SnapshotField>& fields) {
  for (const auto& field : fields) {
    if (field.components == 1) {
      add_range(rows, where, field, field.name, [](const double* v) { return v[0]; });
      continue;
    }
    const auto names = component_names(field);
    for (std::size_t c = 0; c < names.size(); ++c)
      add_range(rows, where, field, field.name + "." + names[c], [c](const double* v) { return v[c]; });
    if (names[0] == "x")
      add_range(rows, where, field, field.name + ".magnitude",
                [](const double* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); });
  }
}

// A number of a JSON file as a person wants to read it.
std::string shortened(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || text.find_first_of(".e") == std::string::npos)
    return text;
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

void about_snapshot(const fs::path& file) {
  const std::string name = file.stem().string(), bonds = "_bonds";
  if (name.size() > bonds.size() && name.substr(name.size() - bonds.size()) == bonds) {
    const fs::path blocks =
        file.parent_path() / (name.substr(0, name.size() - bonds.size()) + file.extension().string());
    throw UsageError(file.string() + " holds the bonds of " + blocks.string() +
                     "; give that file, its bonds are told with it");
  }
  const Snapshot snapshot = read_vtu(file.string());
  std::string bodies;
  for (std::size_t b = 0; b < snapshot.body_names.size(); ++b)
    bodies += (b > 0 ? ", " : "") + std::to_string(b) + " " + snapshot.body_names[b];
  print_rows({{"title", snapshot.title},
              {"bodies", bodies.empty() ? "not told" : bodies},
              {"time", number_text(snapshot.time) + " s"},
              {"step", count_text(snapshot.step)},
              {"points", count_text(static_cast<std::int64_t>(snapshot.points.size()))},
              {"tets", count_text(static_cast<std::int64_t>(snapshot.tets.size()))},
              {"bond triangles", count_text(static_cast<std::int64_t>(snapshot.bonds.triangles.size()))}});
  Rows rows = {{"at", "field", "unit", "lowest", "highest"}};
  add_ranges(rows, "points", snapshot.point_fields);
  add_ranges(rows, "tets", snapshot.cell_fields);
  add_ranges(rows, "bonds", snapshot.bonds.point_fields);
  std::puts("\nfields");
  print_rows(rows);
}

void about_script(const fs::path& file) {
  script::EngineSettings settings;
  settings.script = file;
  settings.output = fs::path("results") / case_name(file, {});
  settings.results = "results";
  settings.threads = available_cores();
  settings.check_only = true;
  settings.observer = std::make_shared<RunObserver>(ProgressStyle::none, nullptr);
  settings.program = program_path().string();
  script::Engine engine(settings);
  engine.run_file();
  const auto parameters = engine.parameters();
  std::puts(parameters.empty() ? "no parameters" : "parameters (--set name=value)");
  if (!parameters.empty())
    std::fputs(parameter_table(parameters).c_str(), stdout);
  if (const std::string models = engine.model_summary(); !models.empty())
    std::printf("\n%s", models.c_str());
}

void about_results(const fs::path& folder) {
  const fs::path log = folder / run_log_name;
  if (!is_run_log(log))
    throw UsageError(folder.string() + " holds no " + run_log_name + ": not a folder of results");
  const RunLogSummary summary = summary_of_run_log(log);
  Rows rows = {{"run", summary.command}, {"started", summary.started}};
  rows.push_back({"ended", summary.exit_code ? "with exit code " + std::to_string(*summary.exit_code)
                                             : std::string("not yet, or killed")});
  if (!summary.error.empty())
    rows.push_back({"error", summary.error});
  if (summary.warnings > 0)
    rows.push_back({"warnings", std::to_string(summary.warnings) + ", in " + run_log_name});
  print_rows(rows);
  if (const fs::path file = folder / "settings.json"; fs::exists(file)) {
    Rows parameters;
    for (const Parameter& p : read_parameters(file))
      parameters.push_back({p.name, shortened(p.value)});
    if (!parameters.empty()) {
      std::puts("\nparameters");
      print_rows(parameters);
    }
  }
  if (const fs::path file = folder / "report.json"; fs::exists(file)) {
    Rows figures = {{"figure", "value", "unit", "reference", "kind", "within"}};
    for (const auto& f : read_report(file))
      figures.push_back({f.name, shortened(f.value), f.unit, shortened(f.reference), f.kind, f.within});
    std::puts("\nreport");
    print_rows(figures);
  }
  Rows files;
  for (const auto& file : files_of_run_log(log))
    if (std::error_code error; fs::exists(folder / file.name, error))
      files.push_back(
          {file.name, count_text(static_cast<std::int64_t>(fs::file_size(folder / file.name))) + " bytes"});
  std::puts("\nfiles");
  print_rows(files);
}

} // namespace

ExitCode info(const fs::path& path) {
  std::error_code none;
  if (path.empty())
    about_program();
  else if (!is_there(path))
    throw script::FileError(path.string() + ": no such file or folder");
  else if (fs::is_directory(path, none))
    about_results(path);
  else if (is_saved_state(path))
    about_snapshot(path);
  else if (path.extension() == ".lua")
    about_script(path);
  else
    throw UsageError(path.string() +
                     ": must be a .vtu, .pvtu or .vtkhdf file, a .lua script or a folder of results");
  return ExitCode::success;
}

} // namespace cdem::app
