// Runs a piece of Lua as a case script in a folder of its own.
#pragma once

#include "lua/binding/files/files.hpp"
#include "lua/binding/runtime/engine.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

namespace cdem::script::test {

namespace fs = std::filesystem;

class Listener : public Observer {
public:
  void message(const std::string& line) override { lines.push_back(line); }
  bool stop_requested() override { return stop && stop(); }
  Activity doing(Activity now) override { return std::exchange(activity, now); }

  Activity activity = Activity::script;
  std::vector<std::string> lines;
  std::function<bool()> stop;
};

// <temporary folder>/<unique>/case.lua, output in .../results/case. Removed at the end.
class Script {
public:
  explicit Script(const std::string& text) {
    static std::atomic<int> count{0};
    folder = fs::canonical(fs::temp_directory_path()) /
             ("cdem_test_lua_" + std::to_string(getpid()) + "_" + std::to_string(++count));
    fs::create_directories(folder / "results" / "case");
    settings.script = folder / "case.lua";
    settings.output = folder / "results" / "case";
    settings.results = folder / "results";
    settings.observer = listener;
    write("case.lua", text);
  }
  ~Script() {
    std::error_code none;
    fs::remove_all(folder, none);
  }
  Script(const Script&) = delete;
  Script& operator=(const Script&) = delete;

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const { return read_file(settings.output / name); }
  bool wrote(const std::string& name) const { return fs::exists(settings.output / name); }

  Script& set(const std::string& name, const std::string& value) {
    settings.set[name] = value;
    return *this;
  }

  void run() {
    engine = std::make_unique<Engine>(settings);
    engine->run_file();
  }

  // The message of the error the script ends with, "" when it ends well. Its folder, which changes from run
  // to run, is left out of it.
  std::string error() {
    try {
      run();
    } catch (const ScriptError& failure) {
      return without_folder(failure.what());
    }
    return {};
  }

  // What the script printed, one line each.
  std::string printed() {
    run();
    std::string all;
    for (const std::string& line : listener->lines)
      all += (all.empty() ? "" : "\n") + line;
    return all;
  }

  fs::path folder;
  std::shared_ptr<Listener> listener = std::make_shared<Listener>();
  EngineSettings settings;
  std::unique_ptr<Engine> engine;

private:
  std::string without_folder(std::string text) const {
    const std::string front = folder.string() + "/";
    for (auto at = text.find(front); at != std::string::npos; at = text.find(front))
      text.erase(at, front.size());
    return text;
  }
};

inline std::string error_of(const std::string& text) {
  return Script(text).error();
}
inline std::string printed_by(const std::string& text) {
  return Script(text).printed();
}

inline std::vector<std::string> warnings_of(const std::string& text) {
  Script script(text);
  script.run();
  std::vector<std::string> warnings;
  for (const std::string& line : script.listener->lines)
    if (line.find("warning: ") != std::string::npos)
      warnings.push_back(line);
  return warnings;
}

// What a script begins with: the module, and close(a, b, tolerance).
inline const std::string opening = "local cdem = require 'cdem'\n"
                                   "local function close(a, b, tolerance)\n"
                                   "  assert(math.abs(a - b) <= (tolerance or 1e-9) * math.max(1, "
                                   "math.abs(b)), a .. ' is not ' .. b)\nend\n";

// A model of nx x ny x nz boxes of 1 m, nu = 0, one side held, ready to be loaded.
inline std::string column(const std::string& divisions = "{2, 1, 1}", const std::string& size = "{2, 1, 1}") {
  return "local cdem = require 'cdem'\n"
         "local rock = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0, density = 2000 }\n"
         "local joint = cdem.mohr_coulomb{ cohesion = 1e9, friction_angle = 30, tensile_strength = 1e9 }\n"
         "local model = cdem.model{ bodies = { { shape = cdem.grid{ size = " +
         size + ", divisions = " + divisions +
         " },\n  material = rock, joint = joint, name = 'column', element = 'small_strain' } } }\n"
         "model:fix{ on = 'x-', axes = 'xyz' }\n";
}

inline std::vector<std::string> those_with(const std::vector<std::string>& lines, const std::string& words) {
  std::vector<std::string> found;
  std::copy_if(lines.begin(), lines.end(), std::back_inserter(found),
               [&](const std::string& line) { return line.find(words) != std::string::npos; });
  return found;
}

} // namespace cdem::script::test
