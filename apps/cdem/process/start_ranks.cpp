#include "apps/cdem/process/start_ranks.hpp"

#include "apps/cdem/process/build_info.hpp"
#include "apps/cdem/process/failure.hpp"
#include "apps/cdem/process/interrupt.hpp"
#include "apps/cdem/process/standard_files.hpp"
#include "libcdem/ranks/ranks.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace cdem::app {

namespace {

constexpr std::chrono::milliseconds between_looks{20};
constexpr int no_such_program = 127; // as a shell says it

// Signals that came since the last look, in order; mpirun itself would kill the ranks at once.
std::atomic<int> asked{0}, times_asked{0};

extern "C" void ask(int signal) {
  asked.store(signal);
  times_asked.fetch_add(1);
}

void hear_signals() {
  struct sigaction action {};
  action.sa_handler = ask;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM})
    sigaction(signal, &action, nullptr);
}

// Open MPI takes these from the environment; another mpirun does not mind them. What the user has set stays.
void set_up_mpi() {
  const auto set = [](const char* name, const char* value) { setenv(name, value, 0); };
  set("OMPI_MCA_rmaps_base_oversubscribe", "1");           // more ranks than cores
  set("OMPI_MCA_hwloc_base_binding_policy", "none");       // the system places the threads of all ranks
  set("OMPI_MCA_mpi_yield_when_idle", "1");                // who waits leaves its core to the others
  set("OMPI_MCA_btl_vader_single_copy_mechanism", "none"); // refused in many containers, and told of there
  set("OMPI_MCA_orte_execute_quiet", "1");
  set("HWLOC_HIDE_ERRORS", "2"); // hwloc tells of containers without /sys, which no rank needs
  if (geteuid() == 0) {
    set("OMPI_ALLOW_RUN_AS_ROOT", "1");
    set("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
  }
}

// What mpirun prints itself: kept for when it fails.
class Said {
public:
  Said() : file_(memfd_create("mpirun", MFD_CLOEXEC)) {}
  ~Said() { close(file_); }
  Said(const Said&) = delete;
  Said& operator=(const Said&) = delete;
  int file() const { return file_; }
  // The first line that `good` takes; "": none.
  template <class Good>
  std::string line(const Good& good) const {
    std::string text(static_cast<std::size_t>(std::max<off_t>(0, lseek(file_, 0, SEEK_END))), '\0');
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, pread(file_, text.data(), text.size(), 0))));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      if (good(line))
        return line;
    return {};
  }

private:
  int file_;
};

pid_t start(std::vector<std::string> command, const Said& said) {
  std::vector<char*> words;
  words.reserve(command.size() + 1);
  for (std::string& word : command)
    words.push_back(word.data());
  words.push_back(nullptr);
  const pid_t process = fork();
  if (process != 0)
    return process;
  setpgid(0, 0); // Ctrl-C is ours to pass on
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE})
    std::signal(signal, SIG_DFL);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  dup2(nothing, STDIN_FILENO);
  dup2(said.file(), STDOUT_FILENO);
  dup2(said.file(), STDERR_FILENO);
  execvp(words.front(), words.data());
  _exit(no_such_program);
}

void pass_on(int& passed, pid_t mpirun, const StandardFiles& files) {
  for (; passed < times_asked.load(); ++passed)
    if (files.rank_0() > 0)
      kill(files.rank_0(), asked.load());
    else
      kill(mpirun, SIGTERM); // none of them has begun
}

} // namespace

ExitCode start_ranks(int count, const std::vector<std::string>& words) {
  if (module_of_ranks().empty())
    throw UsageError("--ranks: cdem was built without MPI; install libopenmpi-dev and build it again");
  set_up_mpi();
  hear_signals();
  StandardFiles files;
  const Said said;
  std::vector<std::string> command = {"mpirun", "-n", std::to_string(count), program_path().string()};
  command.insert(command.end(), words.begin(), words.end());
  const pid_t mpirun = start(std::move(command), said);
  if (mpirun < 0)
    throw UsageError(std::string("--ranks: mpirun cannot be started: ") + std::strerror(errno));
  int status = 0, passed = 0;
  while (waitpid(mpirun, &status, WNOHANG) == 0) {
    files.look();
    pass_on(passed, mpirun, files);
    std::this_thread::sleep_for(between_looks);
  }
  files.look();
  if (files.exit_code() >= 0)
    return static_cast<ExitCode>(files.exit_code());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (code == no_such_program && files.rank_0() == 0 &&
      said.line([](const std::string&) { return true; }).empty())
    throw UsageError("--ranks needs mpirun, of the package openmpi-bin, and finds none");
  if (times_asked.load() > 0 && files.rank_0() == 0) { // none of them had begun
    const bool terminated = asked.load() == SIGTERM;
    std::fprintf(stderr, "cdem: error: stopped by %s\n", terminated ? "SIGTERM" : "Ctrl-C");
    return terminated ? ExitCode::terminated : ExitCode::interrupted;
  }
  const std::string own = "cdem: error: ";
  const std::string line =
      said.line([&](const std::string& text) { return text.compare(0, own.size(), own) == 0; });
  if (!line.empty()) { // of a rank that has failed alone
    std::fprintf(stderr, "%s\n", line.c_str());
    return static_cast<ExitCode>(code);
  }
  if (files.rank_0() > 0)
    throw RankLost(
        "a rank was killed, perhaps for want of memory, and all were ended; cdem resume goes on from the "
        "last checkpoint");
  if (code > 128)
    throw RankLost("a rank was killed before the run had begun, perhaps for want of memory");
  throw UsageError("mpirun cannot start " + std::to_string(count) +
                   " ranks: " + said.line([](const std::string& text) {
                     return text.find_first_not_of("- \t") != std::string::npos;
                   }));
}

} // namespace cdem::app
