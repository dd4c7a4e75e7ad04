// A script that is stopped and goes on.
#pragma once

#include "libcdem/step/errors.hpp"
#include "tests/lua/script.hpp"

namespace cdem::script::test {

struct StoppedScript : Script {
  explicit StoppedScript(const std::string& text) : Script(text) {
    write("helper.lua", "return { factor = 1 }");
  }

  // Runs to its end; returns how often it looked whether to stop.
  int count_looks() {
    int looks = 0;
    listener->stop = [&] { return ++looks < 0; };
    run();
    listener->stop = nullptr;
    return looks;
  }
  // Stops at the given look; true when the script had ended before.
  bool ends_before(int look) {
    int looks = 0;
    listener->stop = [&] { return ++looks >= look; };
    try {
      run();
    } catch (const cdem::Interrupted&) {
      listener->stop = nullptr;
      return false;
    }
    listener->stop = nullptr;
    return true;
  }
  // What it wrote, without the folder's own name.
  std::string text(const std::string& name) const {
    std::string all = read(name);
    const std::string own = folder.filename().string();
    for (auto at = all.find(own); at != std::string::npos; at = all.find(own))
      all.erase(at, own.size());
    return all;
  }
  void go_on_from_newest() { settings.resume = newest_checkpoint(settings.output).file; }
};

} // namespace cdem::script::test
