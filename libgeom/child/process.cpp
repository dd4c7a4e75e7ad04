#include "libgeom/child/process.hpp"

#include "libgeom/core/error.hpp"
#include "libgeom/core/plain_reason.hpp"
#include "libgeom/core/stop.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>

#include <fcntl.h>
#include <omp.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace geom {
namespace {

// The first byte that the child sends: what the others are.
enum Answer : char { result = 'r', bad_input = 'i', failure = 'f', no_memory = 'm', unknown = 'u' };

constexpr int wait_ms = 50; // between looks at whether the user asks to stop

// Lowers the limits that there are, never raises one.
void limit(int resource, rlim_t to) {
  rlimit now{};
  getrlimit(static_cast<__rlimit_resource_t>(resource), &now);
  now.rlim_cur = std::min(now.rlim_cur, to);
  setrlimit(static_cast<__rlimit_resource_t>(resource), &now);
}

std::uint64_t address_space() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

// The child: nothing of the terminal, of open files and of the parent's signals reaches it, and it ends with its parent.
void settle_in(const ChildLimits& limits, int pipe, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent)
    _exit(1);
  for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTERM, SIGXCPU})
    std::signal(number, SIG_DFL);
  for (const int number : {SIGINT, SIGPIPE}) // Ctrl-C is the parent's to answer
    std::signal(number, SIG_IGN);
  const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    dup2(null, file);
  if (pipe > 3)
    close_range(3, static_cast<unsigned>(pipe) - 1, 0);
  close_range(static_cast<unsigned>(pipe) + 1, ~0U, 0);
  limit(RLIMIT_CORE, 0);
  if (limits.seconds > 0)
    limit(RLIMIT_CPU, limits.seconds);
  if (limits.memory > 0)
    limit(RLIMIT_AS, address_space() + limits.memory);
  std::ofstream("/proc/self/oom_score_adj") << 1000; // short of memory, the kernel ends this one, not the run
  omp_set_num_threads(1);
}

void send(int pipe, Answer kind, const std::string& bytes) {
  if (write(pipe, &kind, 1) != 1)
    return;
  for (std::size_t done = 0; done < bytes.size();) {
    const auto count = write(pipe, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR)
      continue;
    if (count <= 0)
      _exit(1);
    done += static_cast<std::size_t>(count);
  }
}

[[noreturn]] void be_child(const ChildLimits& limits, int pipe, pid_t parent,
                           const std::function<std::string()>& work) {
  settle_in(limits, pipe, parent);
  try {
    send(pipe, result, work());
  } catch (const InputError& error) {
    send(pipe, bad_input, error.what());
  } catch (const std::bad_alloc&) {
    send(pipe, no_memory, "");
  } catch (const std::exception& error) {
    send(pipe, failure, plain_reason(error));
  } catch (...) {
    send(pipe, unknown, "");
  }
  _exit(0); // neither destructors nor buffers: they are the parent's
}

// Our end of the pipe and the child itself, which does not outlive this.
class Child {
public:
  Child(pid_t id, int pipe) : id_(id), pipe_(pipe) {}
  ~Child() {
    close(pipe_);
    if (id_ < 0)
      return;
    kill(id_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  std::string read_all() const {
    std::string bytes;
    std::array<char, 65536> buffer{};
    for (;;) {
      throw_if_stopped();
      pollfd ready{pipe_, POLLIN, 0};
      if (poll(&ready, 1, wait_ms) <= 0)
        continue;
      const auto count = read(pipe_, buffer.data(), buffer.size());
      if (count == 0)
        return bytes;
      if (count > 0)
        bytes.append(buffer.data(), static_cast<std::size_t>(count));
      else if (errno != EINTR)
        throw std::runtime_error(std::string("a child process cannot be read: ") + std::strerror(errno));
    }
  }

  int wait() { // its status
    int status = 0;
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status;
  }

private:
  pid_t id_;
  int pipe_;
};

std::string gigabytes(std::uint64_t bytes) {
  return std::to_string((bytes + (1U << 29)) >> 30) + " GiB";
}

[[noreturn]] void tell_no_memory(const std::string& what, const ChildLimits& limits) {
  if (limits.memory == 0)
    throw std::bad_alloc();
  throw InputError(what + ": needs more than the " + gigabytes(limits.memory) +
                   " of memory that it may take");
}

[[noreturn]] void tell_end(const std::string& what, const ChildLimits& limits, int status) {
  const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (limits.seconds > 0 && (number == SIGXCPU || number == SIGKILL))
    throw InputError(what + ": needs more than the " + std::to_string(limits.seconds) +
                     " s of processor time that it may take");
  if (number == SIGKILL)
    throw InputError(what + ": the system ended " + limits.worker + ", most likely for want of memory");
  throw InputError(what + ": " + limits.blame + ": " + limits.worker + " crashed" +
                   (number > 0 ? std::string(" (") + strsignal(number) + ")" : std::string()));
}

using Sharing = std::function<std::string(const std::function<std::string()>&)>;

Sharing& sharing() {
  static Sharing share;
  return share;
}

std::string run_here(const std::string& what, const ChildLimits& limits,
                     const std::function<std::string()>& work) {
  throw_if_stopped();
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::runtime_error(what + ": no pipe to a child process: " + std::strerror(errno));
  const pid_t parent = getpid(), id = fork();
  if (id == 0)
    be_child(limits, ends[1], parent, work);
  close(ends[1]);
  if (id < 0) {
    const int reason = errno;
    close(ends[0]);
    throw std::runtime_error(what + ": no child process can be started: " + std::strerror(reason));
  }
  Child child(id, ends[0]);
  std::string answer = child.read_all();
  const int status = child.wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.empty())
    tell_end(what, limits, status);
  const char kind = answer.front();
  answer.erase(0, 1);
  switch (kind) {
  case result:
    return answer;
  case bad_input:
    throw InputError(answer);
  case failure:
    throw std::runtime_error(answer);
  case no_memory:
    tell_no_memory(what, limits);
  default:
    throw InputError(what + ": " + limits.blame);
  }
}

} // namespace

ChildLimits limits_of_file(const std::string& path) {
  constexpr std::uint64_t least_memory = std::uint64_t{2} << 30, memory_per_byte = 100;
  constexpr std::uint64_t least_seconds = 60, bytes_per_second = 100'000, most_seconds = 100'000;
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(path, none);
  ChildLimits limits;
  limits.blame = "the file is damaged, or not what its name says";
  if (none)
    return limits; // the reader says why it cannot be read
  limits.memory = least_memory + memory_per_byte * size;
  limits.seconds = static_cast<unsigned>(std::min(least_seconds + size / bytes_per_second, most_seconds));
  return limits;
}

void set_sharing(Sharing share) {
  sharing() = std::move(share);
}

std::string run_in_child(const std::string& what, const ChildLimits& limits,
                         const std::function<std::string()>& work) {
  const auto run = [&] { return run_here(what, limits, work); };
  return sharing() ? sharing()(run) : run();
}

} // namespace geom
