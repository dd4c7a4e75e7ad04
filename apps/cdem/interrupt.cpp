#include "apps/cdem/interrupt.hpp"

#include <atomic>
#include <csignal>
#include <ctime>
#include <sys/prctl.h>
#include <unistd.h>

namespace cdem::app::interrupt {

namespace {

// Lock-free, so that the handler may touch them.
std::atomic<int> received{0};
std::atomic<bool> on_terminal{false};
std::atomic<long long> received_at{0}; // ms of the monotonic clock

// One key press can arrive twice, from the terminal and from a shell that passes it on.
constexpr long long same_press_ms = 300;

long long now_ms() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<long long>(now.tv_sec) * 1000 + now.tv_nsec / 1000000;
}

extern "C" void handle(int signal) {
  const long long now = now_ms();
  if (received.load() == 0) {
    received_at.store(now);
    received.store(signal);
    return;
  }
  if (now - received_at.load() < same_press_ms)
    return;
  static constexpr char line_feed = '\n'; // behind the live line
  static constexpr char line[] =
      "cdem: error: stopped at once by a second signal, unfinished files may be left\n";
  if (on_terminal.load() && write(STDERR_FILENO, &line_feed, 1) != 1)
    _exit(to_int(ExitCode::interrupted));
  [[maybe_unused]] const auto written = write(STDERR_FILENO, line, sizeof line - 1);
  _exit(signal == SIGTERM ? to_int(ExitCode::terminated) : to_int(ExitCode::interrupted));
}

} // namespace

void with_parent() {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
}

void install() {
  std::signal(SIGXFSZ, SIG_IGN); // a file above `ulimit -f` fails like a full disk, with a reason
  on_terminal.store(isatty(STDERR_FILENO) == 1);
  struct sigaction action {};
  action.sa_handler = handle;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool requested() {
  return received.load() != 0;
}
void clear() {
  received.store(0);
}
ExitCode exit_code() {
  return received.load() == SIGTERM ? ExitCode::terminated : ExitCode::interrupted;
}

} // namespace cdem::app::interrupt
