// Runs commands side by side, a few at a time.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace cdem::script {

struct Job {
  std::vector<std::string> command; // program and arguments, no shell in between
  std::filesystem::path console;    // takes what the program prints
  int exit_code = -1;               // 128 + signal when one ended it
  double seconds = 0;               // wall clock
};

// Starts at most `parallel` jobs at once, in order. `done` is called as each ends, in the order they end;
// `stop` is asked some times a second: when it says true, running jobs get SIGINT (and SIGKILL after 10 s),
// no more are started and false is returned. Each job is in a process group of its own, so that a Ctrl-C
// reaches it through `stop` only. Throws FileError when a program cannot be started.
bool run_jobs(std::vector<Job>& jobs, int parallel, const std::function<bool()>& stop,
              const std::function<void(const Job&)>& done);

} // namespace cdem::script
