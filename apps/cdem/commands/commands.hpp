// The commands. Each returns the exit code or throws what failure.hpp judges.
#pragma once

#include "apps/cdem/process/exit_code.hpp"
#include "apps/cdem/progress/run_observer.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace cdem::app {

using Settings = std::map<std::string, std::string>; // --set name=value, as typed

// How a script is to be solved, whether it begins or goes on.
struct SolvingCommand {
  int threads = 0;     // 0: every core this process may use
  bool unsafe = false; // the user's word, never a file's
  ProgressStyle progress = ProgressStyle::automatic;
  std::size_t memory = 0;         // bytes; 0: most of the machine's
  double checkpoint_minutes = 10; // between checkpoints of a long stage; 0: none
  bool live = false;              // shown in a browser while it goes on
  std::string line;               // the command line, for the log
};

struct RunCommand : SolvingCommand {
  std::filesystem::path script;
  std::filesystem::path sources; // folder with the text that a sweep kept of it; empty: none did
  std::filesystem::path output;  // empty: results/<case>
  Settings set;
  std::filesystem::path resume; // checkpoint to go on from; empty: from the start
  bool ends_with_parent = false;
};
ExitCode run(const RunCommand&);

struct ResumeCommand : SolvingCommand {
  std::filesystem::path folder; // the output folder of the run
};
// Goes on from the folder's newest checkpoint, with the script and settings it tells of. A run that was --unsafe is
// refused without it: a file does not open the machine to a script.
ExitCode resume(const ResumeCommand&);

struct CheckCommand {
  std::filesystem::path script;
  int threads = 0;
  Settings set;
  bool unsafe = false;
  std::size_t memory = 0;
};
ExitCode check(const CheckCommand&);

struct RenderCommand {
  std::filesystem::path file;        // .vtu
  std::filesystem::path output;      // empty: beside the file, named after it and the colour
  std::optional<std::string> colour; // none: displacement.magnitude, or what else the file has
  double deformation = 0;
  std::string view = "front", up = "y", colour_map = "auto", title;
  std::array<int, 2> size = {1600, 1200}; // pixels; height 0: as high as the picture needs
  double dpi = 300;                       // where it is printed
  std::optional<std::array<double, 2>> range;
  std::vector<std::string> hidden; // bodies, by their names or by their numbers in field body
  bool edges = true, broken_bonds = true, colour_bar = true, legend = true, axes = true;
};
ExitCode render_picture(const RenderCommand&);

// Saved files in a page of this machine: a .vtu, a .pvd or an output folder.
ExitCode view(const std::filesystem::path&);

// About this program, a .vtu, a script or an output folder.
ExitCode info(const std::filesystem::path&);

struct SweepCommand {
  std::filesystem::path script;
  std::filesystem::path output;   // empty: results/<case>-sweep
  std::vector<Settings> settings; // one run each
  int jobs = 0;                   // side by side; 0: one a core
  int threads = 0;                // of each run; 0: the cores shared among the jobs
  bool unsafe = false, quiet = false;
  std::size_t memory = 0; // bytes of all runs together; 0: most of the machine's
  std::string line;
  std::vector<std::string> sets; // the settings as typed
  int ranks = 1;                 // of each run, with Slurm
};
ExitCode sweep(const SweepCommand&);
ExitCode write_job_array(const SweepCommand&);      // for Slurm
ExitCode run_point(const SweepCommand&, int point); // the point-th of its runs, from 1: a task of that array

struct ReplCommand {
  int threads = 0;
  bool unsafe = false;
  std::size_t memory = 0;
};
ExitCode repl(const ReplCommand&);

ExitCode print_annotations();

// From a mesh that meshio reads to a .vtu of tetrahedra or a .stl of triangles.
ExitCode convert(const std::string& from, const std::string& to);

} // namespace cdem::app
