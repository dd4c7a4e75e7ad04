// Runs one case script: sandbox, parameters, the `cdem` module, the models it makes. No Lua header is shown
// here.
#pragma once

#include "lua/binding/session/settings.hpp"

namespace cdem::script {

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

} // namespace cdem::script
