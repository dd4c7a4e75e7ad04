// Runs one case script: sandbox, parameters, the `cdem` module, the models it makes. No Lua header is shown
// here.
#pragma once

#include "libcdem/step/observer.hpp"
#include "libcdem/vtk/file_error.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace cdem::script {

// An error in the script or its input, with "file:line: " in front. Exit code 2.
class ScriptError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

using cdem::FileError; // a file could not be read or written; exit code 4

struct EngineSettings {
  std::filesystem::path script;  // the .lua file; empty for the repl
  std::filesystem::path output;  // folder the script may write into; made when first needed
  std::filesystem::path results; // root of all results; the script may read everything below it
  std::filesystem::path sources; // folder with the text that a sweep kept (sources.hpp); empty: none was
  int threads = 1;
  std::map<std::string, std::string> set; // --set name=value, as typed
  bool unsafe = false;                    // the whole Lua library, files anywhere
  bool check_only = false;                // solving calls return typed, empty results
  std::shared_ptr<Observer> observer;
  // Told of each file just before it is written; may be empty.
  std::function<void(const std::filesystem::path&)> will_write;
  std::string program;          // path of the cdem program, for sweeps
  std::filesystem::path resume; // checkpoint to go on from; empty: from the start
  double checkpoint_minutes =
      0;                  // between checkpoints in solving calls; 0: only asked ones and those of a stop
  std::uint64_t run = 0;  // number of the run, which its checkpoints keep
  std::size_t memory = 0; // bytes that this process may take; 0: no limit
};

// What a run needs to know of a checkpoint before it goes on from it.
struct CheckpointInfo {
  std::filesystem::path file;
  std::filesystem::path script; // absolute
  std::map<std::string, std::string> set;
  bool unsafe = false;
  std::uint64_t serial = 0; // counts the checkpoints of a run
};
// The later of the two of an output folder that are whole and of this run (0: of any). Throws FileError when there is
// none.
CheckpointInfo newest_checkpoint(const std::filesystem::path& folder, std::uint64_t run = 0);

// One declared parameter of a script (cdem.parameter).
struct ParameterInfo {
  std::string name, type, default_text, value_text, range_text, unit, doc;
};

class Engine {
public:
  explicit Engine(EngineSettings);
  ~Engine();

  // Throws ScriptError, FileError, cdem::SolutionError, cdem::Interrupted. An unknown --set name is a
  // ScriptError that names the nearest declared parameter; judged when the script has ended, and at once when
  // a name is close to none.
  void run_file();

  // repl: runs a line or chunk; returns the printed form of its values; incomplete = true when more lines are
  // needed.
  std::string run_line(const std::string& text, bool& incomplete);
  std::vector<std::string> complete(const std::string& prefix) const; // names that start so, for the tab key

  std::vector<ParameterInfo> parameters() const;
  std::string model_summary() const; // for `cdem check`: bodies, blocks, tets, bonds, box, conditions, stages
  // For another thread, while that of the script does not come back from one call: writes a checkpoint if the call is
  // no half-done one of a model, and says where the script stands ("case.lua:12, cdem.voronoi"; "" when unknown).
  std::string leave_stuck_script();
  // Writes last_good.vtu of every model that failed; true when something was written.
  bool model_saved_after_failure();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// LuaCATS annotations of the whole `cdem` module, generated from the same tables that check the arguments.
std::string annotations();
// The reference page of the script language, generated likewise.
std::string reference();

} // namespace cdem::script
