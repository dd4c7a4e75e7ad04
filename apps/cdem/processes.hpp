// Runs many processes, some of them side by side, and passes on what they print. Each is in a process group
// of its own, so that Ctrl-C reaches them once, from here; each ends when this program dies.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace cdem::app {

struct ProcessEvents {
  std::function<void(std::size_t job)> started;
  std::function<void(std::size_t job, const std::string& line)> printed; // on stdout
  std::function<void(std::size_t job, int exit_code, const std::string& error)>
      ended;                  // error: stderr's last line
  std::function<void()> tick; // about ten times a second
};

// jobs: program and arguments of each. Starts them in order, at most at_once running. Once stop() is true no
// more are started, the running ones are asked to end by SIGTERM and waited for. Throws std::runtime_error
// when no process can be made.
void run_processes(const std::vector<std::vector<std::string>>& jobs, int at_once,
                   const std::function<bool()>& stop, const ProcessEvents&);

} // namespace cdem::app
