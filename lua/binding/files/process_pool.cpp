#include "lua/binding/files/process_pool.hpp"

#include "libcdem/ranks/ranks.hpp"
#include "lua/binding/schema/errors.hpp"

#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

extern char** environ;

namespace cdem::script {

namespace {

using Clock = std::chrono::steady_clock;

struct Running {
  Job* job;
  pid_t pid;
  Clock::time_point start;
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// What it runs in, but for what would make it take itself for a rank of ours.
std::vector<char*> environment_of_job() {
  std::vector<char*> words;
  for (char** word = environ; *word != nullptr; ++word) {
    const std::string text = *word;
    const auto begins = [&](const char* start) { return text.rfind(start, 0) == 0; };
    if (ranks().alone() || !(begins("OMPI_") || begins("PMIX_") || begins("PMI_") || begins("CDEM_RANKS_")))
      words.push_back(*word);
  }
  words.push_back(nullptr);
  return words;
}

pid_t start(const Job& job) {
  std::vector<char*> arguments;
  for (const std::string& word : job.command)
    arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, job.console.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);

  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, reset;
  sigemptyset(&none);
  sigemptyset(&reset);
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE})
    sigaddset(&reset, signal);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &reset);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);

  pid_t pid = -1;
  std::vector<char*> environment = environment_of_job();
  const int error =
      posix_spawnp(&pid, arguments[0], &files, &attributes, arguments.data(), environment.data());
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (error != 0)
    throw FileError(job.command[0] + ": cannot be started: " + std::strerror(error));
  return pid;
}

// True when the job has ended; its exit code and time are then known.
bool ended(Running& running) {
  int status = 0;
  const pid_t pid = waitpid(running.pid, &status, WNOHANG);
  if (pid == 0 || (pid < 0 && errno == EINTR))
    return false;
  running.job->seconds = seconds_since(running.start);
  running.job->exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return true;
}

void end_all(std::vector<Running>& all) {
  for (const Running& running : all)
    kill(-running.pid, SIGINT);
  const auto asked = Clock::now();
  bool killed = false;
  while (!all.empty()) {
    for (auto it = all.begin(); it != all.end();)
      it = ended(*it) ? all.erase(it) : it + 1;
    if (!killed && seconds_since(asked) > 10) {
      for (const Running& running : all)
        kill(-running.pid, SIGKILL);
      killed = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

} // namespace

bool run_jobs(std::vector<Job>& jobs, int parallel, const std::function<bool()>& stop,
              const std::function<void(const Job&)>& done) {
  std::vector<Running> running;
  std::size_t next = 0;
  try {
    while (next < jobs.size() || !running.empty()) {
      while (next < jobs.size() && static_cast<int>(running.size()) < parallel) {
        running.push_back({&jobs[next], start(jobs[next]), Clock::now()});
        ++next;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (stop()) {
        end_all(running);
        return false;
      }
      for (auto it = running.begin(); it != running.end();) {
        if (!ended(*it)) {
          ++it;
          continue;
        }
        const Job* job = it->job;
        it = running.erase(it);
        done(*job);
      }
    }
  } catch (...) {
    end_all(running);
    throw;
  }
  return true;
}

} // namespace cdem::script
