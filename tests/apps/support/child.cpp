#include "tests/apps/support/child.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <poll.h>
#include <pty.h>
#include <sstream>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace testing {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Ends {
  int read = -1, write = -1;
};

Ends make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::runtime_error("no pipe");
  return {ends[0], ends[1]};
}

struct Child {
  pid_t id = -1;
  int in = -1, out = -1, err = -1; // our ends; one file for all on a terminal
};

[[noreturn]] void become(const std::vector<std::string>& command, const Start& start) {
  if (!start.folder.empty() && chdir(start.folder.c_str()) != 0)
    _exit(126);
  setenv("TERM", "xterm", 1);
  setenv("NO_COLOR", "1", 1); // what a terminal shows is read as words
  for (const auto& setting : start.environment)
    putenv(const_cast<char*>(setting.c_str()));
  std::vector<char*> words;
  for (const auto& word : command)
    words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  execv(words[0], words.data());
  _exit(127);
}

Child start_piped(const std::vector<std::string>& command, const Start& start) {
  const Ends in = make_pipe(), out = make_pipe(), err = make_pipe();
  const pid_t id = fork();
  if (id < 0)
    throw std::runtime_error("no process");
  if (id == 0) {
    dup2(in.read, STDIN_FILENO);
    dup2(out.write, STDOUT_FILENO);
    dup2(err.write, STDERR_FILENO);
    become(command, start);
  }
  close(in.read);
  close(out.write);
  close(err.write);
  return {id, in.write, out.read, err.read};
}

Child start_in_terminal(const std::vector<std::string>& command, const Start& start) {
  winsize size{};
  size.ws_row = 24;
  size.ws_col = static_cast<unsigned short>(start.columns);
  int file = -1;
  const pid_t id = forkpty(&file, nullptr, nullptr, &size);
  if (id < 0)
    throw std::runtime_error("no terminal");
  if (id == 0)
    become(command, start);
  return {id, file, file, -1};
}

// False at the end of the file.
bool read_some(int file, std::string& text) {
  std::array<char, 65536> buffer{};
  const auto count = read(file, buffer.data(), buffer.size());
  if (count < 0 && errno == EINTR)
    return true;
  if (count <= 0)
    return false; // a terminal whose program has ended says EIO
  text.append(buffer.data(), static_cast<std::size_t>(count));
  return true;
}

void write_all(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const auto count = write(file, text.data() + done, text.size() - done);
    if (count <= 0)
      return; // the program does not read it
    done += static_cast<std::size_t>(count);
  }
}

} // namespace

TempFolder::TempFolder() {
  std::string name = (fs::temp_directory_path() / "cdem_test_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw std::runtime_error("no temporary folder");
  path_ = fs::canonical(name);
}

TempFolder::~TempFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void write_file(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

std::string read_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    lines.push_back(line);
  return lines;
}

Outcome run_program(const std::vector<std::string>& command, const Start& start) {
  std::signal(SIGPIPE, SIG_IGN);
  const auto began = Clock::now();
  const Child child = start.terminal ? start_in_terminal(command, start) : start_piped(command, start);
  if (!start.terminal) {
    write_all(child.in, start.input);
    close(child.in);
  }

  Outcome outcome;
  bool signalled = start.signal == 0;
  Clock::time_point signal_time;
  std::size_t next_key = 0, seen = 0;
  std::array<pollfd, 2> files = {pollfd{child.out, POLLIN, 0}, pollfd{child.err, POLLIN, 0}};
  while (files[0].fd >= 0 || files[1].fd >= 0) {
    poll(files.data(), files.size(), 20);
    if (files[0].revents != 0 && !read_some(files[0].fd, outcome.out))
      files[0].fd = -1;
    if (files[1].revents != 0 && !read_some(files[1].fd, outcome.err))
      files[1].fd = -1;
    if (next_key < start.keys.size()) {
      const Key& key = start.keys[next_key];
      if (const auto at = outcome.out.find(key.wait_for, seen); at != std::string::npos) {
        seen = at + key.wait_for.size();
        ++next_key;
        std::this_thread::sleep_for(std::chrono::duration<double>(key.pause));
        write_all(child.in, key.press);
      }
    }
    if (!signalled && outcome.out.find(start.signal_after) != std::string::npos) {
      kill(child.id, start.signal);
      signalled = true;
      signal_time = Clock::now();
    }
    if (!outcome.timed_out && seconds_since(began) > start.limit) {
      kill(child.id, SIGKILL);
      outcome.timed_out = true;
    }
  }
  if (start.terminal) {
    close(child.in);
  } else {
    close(child.out);
    close(child.err);
  }
  int status = 0;
  rusage usage{};
  wait4(child.id, &status, 0, &usage);
  outcome.seconds = seconds_since(began);
  if (start.signal != 0 && signalled)
    outcome.after_signal = seconds_since(signal_time);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.peak_memory = 1024.0 * static_cast<double>(usage.ru_maxrss);
  return outcome;
}

Outcome run_cdem(const std::vector<std::string>& arguments, const Start& start) {
  std::vector<std::string> command = {CDEM_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run_program(command, start);
}

} // namespace testing
