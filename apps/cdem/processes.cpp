#include "apps/cdem/processes.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cdem::app {

namespace {

constexpr int tick_ms = 100;

struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
      throw std::runtime_error(std::string("no pipe can be made: ") + std::strerror(errno));
    read_end = ends[0];
    write_end = ends[1];
  }
};

// Lines out of what arrives in pieces.
struct LineReader {
  int file = -1;
  std::string rest;

  // Calls `line` for each whole line; closes the file at its end.
  template <class Line>
  void read_some(Line line) {
    std::array<char, 4096> buffer{};
    const auto count = read(file, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR)
      return;
    if (count <= 0) {
      close(file);
      file = -1;
      if (!rest.empty())
        line(rest);
      return;
    }
    rest.append(buffer.data(), static_cast<std::size_t>(count));
    for (auto end = rest.find('\n'); end != std::string::npos; end = rest.find('\n')) {
      line(rest.substr(0, end));
      rest.erase(0, end + 1);
    }
  }
};

struct Process {
  std::size_t job = 0;
  pid_t id = -1;
  LineReader out, err;
  std::string error;
};

[[noreturn]] void become(const std::vector<char*>& arguments, const Pipe& out, const Pipe& err,
                         pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent)
    _exit(1); // it died before the line above
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(out.write_end, STDOUT_FILENO);
  dup2(err.write_end, STDERR_FILENO);
  execv(arguments[0], arguments.data());
  static constexpr char line[] = "the program cannot be started\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, line, sizeof line - 1);
  _exit(1);
}

Process start(std::size_t job, const std::vector<std::string>& words) {
  const Pipe out, err;
  std::vector<char*> arguments;
  for (const auto& word : words)
    arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t id = fork();
  if (id == 0)
    become(arguments, out, err, parent);
  close(out.write_end);
  close(err.write_end);
  if (id < 0) {
    close(out.read_end);
    close(err.read_end);
    throw std::runtime_error(std::string("no process can be made: ") + std::strerror(errno));
  }
  Process process;
  process.job = job;
  process.id = id;
  process.out.file = out.read_end;
  process.err.file = err.read_end;
  return process;
}

int wait_for(pid_t id) {
  int status = 0;
  while (waitpid(id, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void read_all(std::vector<Process>& running, const ProcessEvents& events) {
  std::vector<pollfd> files;
  for (const auto& process : running)
    for (const int file : {process.out.file, process.err.file})
      files.push_back({file, POLLIN, 0}); // poll leaves out those below zero
  if (poll(files.data(), files.size(), tick_ms) <= 0)
    return;
  for (std::size_t i = 0; i < running.size(); ++i) {
    Process& process = running[i];
    if (files[2 * i].revents != 0)
      process.out.read_some([&](const std::string& line) { events.printed(process.job, line); });
    if (files[2 * i + 1].revents != 0)
      process.err.read_some([&](const std::string& line) { process.error = line; });
  }
}

} // namespace

void run_processes(const std::vector<std::vector<std::string>>& jobs, int at_once,
                   const std::function<bool()>& stop, const ProcessEvents& events) {
  std::vector<Process> running;
  std::size_t next = 0;
  bool stopping = false;
  while (!running.empty() || (next < jobs.size() && !stopping)) {
    while (!stopping && next < jobs.size() &&
           running.size() < static_cast<std::size_t>(std::max(at_once, 1))) {
      running.push_back(start(next, jobs[next]));
      events.started(next++);
    }
    read_all(running, events);
    for (auto process = running.begin(); process != running.end();) {
      if (process->out.file >= 0 || process->err.file >= 0) {
        ++process;
        continue;
      }
      events.ended(process->job, wait_for(process->id), process->error);
      process = running.erase(process);
    }
    if (!stopping && stop()) {
      stopping = true;
      for (const auto& process : running)
        kill(process.id, SIGTERM);
    }
    events.tick();
  }
}

} // namespace cdem::app
