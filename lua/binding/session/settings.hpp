// What a run is asked for, and what is known of one that was begun.
#pragma once

#include "lua/binding/schema/errors.hpp"

#include "libcdem/step/observer.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace cdem::script {

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

} // namespace cdem::script
