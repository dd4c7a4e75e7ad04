// What a running script has declared and done so far. Knows nothing of Lua.
#pragma once

#include "lua/binding/files/files.hpp"
#include "lua/binding/report/report.hpp"
#include "lua/binding/schema/value.hpp"
#include "lua/binding/session/replay.hpp"
#include "lua/binding/session/settings.hpp"

#include <chrono>
#include <functional>

namespace cdem::script {

struct ModelObject;

// A solving call: numbered, hashed by its arguments, so that a resumed script can tell a finished stage from
// a changed one.
struct Stage {
  int number = 0; // over all models of the script, from 1
  int model = 0;  // from 1, in the order the script made them
  std::string kind;
  std::uint64_t hash = 0; // of the kind, the model and the canonical text of the arguments
  Value result;
};

// What is said about a model even after the script has let go of it.
struct ModelNotes {
  std::string built;                      // bodies, blocks, tets, bonds, size
  std::vector<std::string> process_zones; // one line each
  std::vector<std::string> conditions;    // one line each
  std::vector<std::string> advice;        // what is hardly meant, or takes long, one line each
  std::vector<std::string> apart;  // contacts without an interface when the model was made, one line each
  std::vector<std::string> at_end; // warnings after the last solving call, for when the script has ended
};

struct Parameter {
  ParameterInfo info;
  Value value;
};

struct Session {
  explicit Session(EngineSettings);

  const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  EngineSettings settings;
  Files files;
  std::vector<Parameter> parameters;
  std::vector<Stage> stages;
  std::vector<std::weak_ptr<ModelObject>> models;
  std::vector<std::shared_ptr<ModelNotes>> notes;   // of the same models
  std::vector<std::shared_ptr<ModelObject>> failed; // models whose stage failed or was stopped
  std::vector<std::shared_ptr<ModelObject>> filmed;
  std::vector<std::string> warnings;
  std::set<std::string> appended; // files that a resumed script has opened to add to
  Checkpoints checkpoints{*this};
  Report report; // its warnings are those above

  // Services of the Lua side.
  std::function<std::shared_ptr<Reference>(const Value& plain_table)> new_memory; // for model.memory
  std::function<std::string()> where;    // "case.lua:12" of the running call
  std::function<void()> collect_garbage; // lets go of models that the script no longer holds

  double elapsed() const; // s, since the script began, in the runs that this one goes on from too

  // To the observer; to standard output without one. In a check, nothing once a solving call was passed.
  void message(const std::string& line) const;
  void warn(const std::string& text); // with the place in the script
  // The observer of models: it passes everything on, warnings with the place in the script. Lives no longer than the session.
  std::shared_ptr<Observer> observer_of_models();

  std::shared_ptr<ModelObject> held(const ModelObject&) const; // null once nothing holds it any more

  // Those of `filmed`, when the script has ended or cannot go on. One that cannot be written is a warning.
  void write_films();

  // report.json and report.md; not in a check. FileError when they cannot be written.
  void write_report();

  // Names given with --set that no cdem.parameter has declared: InputError naming the nearest. Called at the
  // first solving call, before hours are spent with a misspelt name, and when the script has ended.
  void check_set_names() const;

private:
  bool take_warning(const std::string& line);
};

} // namespace cdem::script
