// cdem convert: meshio (Debian's python3-meshio) reads what cdem does not. It runs in a process of its own under limits,
// since a damaged file may lead it anywhere.
#include "apps/cdem/commands/commands.hpp"
#include "apps/cdem/commands/convert_script.hpp"
#include "apps/cdem/process/failure.hpp"
#include "libcdem/vtk/file_error.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cdem::app {

namespace {

constexpr rlim_t most_memory = rlim_t{16} << 30; // bytes
constexpr rlim_t most_seconds = 1800;            // of processor time

void limit(int resource, rlim_t most) {
  const rlimit limits{most, most};
  setrlimit(resource, &limits);
}

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() > ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

} // namespace

ExitCode convert(const std::string& from, const std::string& to) {
  if (!ends_with(to, ".vtu") && !ends_with(to, ".stl"))
    throw UsageError("cdem convert: " + to + ": must end in .vtu or .stl");
  if (access(from.c_str(), R_OK) != 0)
    throw FileError(from + ": " + std::strerror(errno));
  const pid_t child = fork();
  if (child < 0)
    throw std::runtime_error(std::string("a process cannot be started: ") + std::strerror(errno));
  if (child == 0) {
    limit(RLIMIT_AS, most_memory);
    limit(RLIMIT_CPU, most_seconds);
    limit(RLIMIT_CORE, 0);
    // Debian's python3, which has python3-meshio. -I: no module is taken from the folder it is called in, nor from the user's.
    execl("/usr/bin/python3", "python3", "-I", "-c", convert_script, from.c_str(), to.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
    return ExitCode::success;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw UsageError("cdem convert needs python3 and python3-meshio: apt install python3-meshio");
  if (WIFSIGNALED(status))
    throw UsageError("cdem convert: " + from +
                     ": reading it took more than 16 GiB or half an hour, or crashed meshio (" +
                     strsignal(WTERMSIG(status)) + ")");
  return ExitCode::bad_input; // its line has been printed
}

} // namespace cdem::app
