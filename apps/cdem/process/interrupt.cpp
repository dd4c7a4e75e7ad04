#include "apps/cdem/process/interrupt.hpp"

#include "apps/cdem/process/rank.hpp"
#include "libcdem/ranks/ranks.hpp"
#include "lua/binding/replay/led.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>
#include <mutex>
#include <semaphore.h>
#include <thread>
#include <utility>
#include <vector>

#include <sys/prctl.h>
#include <unistd.h>

namespace cdem::app::interrupt {

namespace {

using std::chrono::milliseconds;

// Lock-free, so that the handler may touch them.
std::atomic<int> received{0};
std::atomic<bool> on_terminal{false};
std::atomic<long long> received_at{0}; // ms of the monotonic clock
sem_t came;                            // a signal has

// Who answers the signal: the run, which leaves by itself, or the waiting thread, which ends the program.
enum class Answer { nobody, run, waiting_thread };
std::atomic<Answer> answer{Answer::nobody};
std::atomic<Activity> activity{Activity::script};
std::atomic<bool> has_finished{false};
std::atomic<bool> follows{false}; // a rank for which rank 0 waits and speaks

// One key press can arrive twice, from the terminal and from a shell that passes it on.
constexpr long long same_press_ms = 300;
// The signal is answered within two seconds: this is left to the run, the rest to what closes the log.
constexpr long long patience_ms = 1500;
constexpr milliseconds look{20};

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
    sem_post(&came);
    return;
  }
  if (now - received_at.load() < same_press_ms || follows.load())
    return;
  static constexpr char line_feed = '\n'; // behind the live line
  static constexpr char line[] =
      "cdem: error: stopped at once by a second signal, unfinished files may be left\n";
  if (on_terminal.load() && write(STDERR_FILENO, &line_feed, 1) != 1)
    _exit(to_int(ExitCode::interrupted));
  [[maybe_unused]] const auto written = write(STDERR_FILENO, line, sizeof line - 1);
  tell_starter(signal == SIGTERM ? to_int(ExitCode::terminated) : to_int(ExitCode::interrupted));
  _exit(signal == SIGTERM ? to_int(ExitCode::terminated) : to_int(ExitCode::interrupted));
}

// Never freed: the waiting thread may be in it while the program ends.
struct Last {
  std::recursive_mutex one_at_a_time;
  std::vector<std::function<void(ExitCode, std::string&)>> steps;
  bool being_taken = false;
};
Last& last() {
  static auto* const steps = new Last;
  return *steps;
}

// The run has not answered in time, and from now on never will.
bool take_over() {
  auto deadline = received_at.load() + patience_ms;
  while (received.load() != 0 && !has_finished.load()) {
    if (activity.load() != Activity::script)
      deadline = std::max(deadline, now_ms() + patience_ms);
    if (now_ms() >= deadline) {
      answer.store(Answer::waiting_thread);
      return true;
    }
    std::this_thread::sleep_for(look);
  }
  return false;
}

void say(const std::string& line) {
  say_as_rank((on_terminal.load() ? "\ncdem: error: " : "cdem: error: ") + line + "\n");
}

// The last steps may wait themselves, say for a pipe that nobody reads: they are not waited for.
void end_soon() {
  const std::string line = received.load() == SIGTERM ? "stopped by SIGTERM" : "stopped by Ctrl-C";
  std::thread([line] { end_now(exit_code(), line); }).detach();
  for (auto deadline = now_ms() + patience_ms; now_ms() < deadline; std::this_thread::sleep_for(look))
    if (activity.load() != Activity::script)
      deadline = now_ms() + patience_ms;
  say(line);
  end_all_ranks(to_int(exit_code()));
}

void wait_for_signals() {
  for (;;) {
    while (sem_wait(&came) != 0) {
    }
    if (!follows.load() && take_over())
      end_soon();
  }
}

} // namespace

void end_now(ExitCode code, std::string line) {
  const std::lock_guard<std::recursive_mutex> lock(last().one_at_a_time);
  const script::WithoutOthers alone;            // they are elsewhere
  if (!std::exchange(last().being_taken, true)) // else a step has failed in its turn
    for (auto step = last().steps.rbegin(); step != last().steps.rend(); ++step)
      try {
        (*step)(code, line);
      } catch (...) { // the line below is what matters
      }
  say(line);
  end_all_ranks(to_int(code));
}

WhenStuck::WhenStuck(std::function<void(ExitCode, std::string&)> step) {
  const std::lock_guard<std::recursive_mutex> lock(last().one_at_a_time);
  last().steps.push_back(std::move(step));
}

WhenStuck::~WhenStuck() {
  const std::lock_guard<std::recursive_mutex> lock(last().one_at_a_time);
  last().steps.pop_back();
}

void with_parent() {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
}

void install() {
  std::signal(SIGXFSZ, SIG_IGN); // a file above `ulimit -f` fails like a full disk, with a reason
  on_terminal.store(isatty(STDERR_FILENO) == 1);
  sem_init(&came, 0, 0);
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before); // signals are the main thread's
  std::thread(wait_for_signals).detach();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  struct sigaction action {};
  action.sa_handler = handle;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool requested() {
  if (received.load() == 0)
    return false;
  auto nobody = Answer::nobody;
  if (!answer.compare_exchange_strong(nobody, Answer::run) && nobody == Answer::waiting_thread)
    for (;;)
      pause();
  return true;
}

bool requested_of_any() {
  if (!script::with_others())
    return requested();
  // The larger of the two is SIGTERM, which takes no patience.
  static_assert(SIGTERM > SIGINT);
  const int mine = !requested() ? 0 : received.load() == SIGTERM ? SIGTERM : SIGINT;
  const int told = static_cast<int>(script::agreed(mine));
  if (told > 0)
    received.store(told);
  return told > 0;
}

void join_ranks() {
  struct sigaction action {};
  action.sa_handler = handle;
  sigemptyset(&action.sa_mask);
  sigaction(SIGUSR1, &action, nullptr);
  follows.store(!ranks().leads());
  on_terminal.store(isatty(STDERR_FILENO) == 1);
}

void clear() {
  received.store(0);
  answer.store(Answer::nobody);
}

ExitCode exit_code() {
  return received.load() == SIGTERM ? ExitCode::terminated : ExitCode::interrupted;
}

Activity doing(Activity now) {
  return activity.exchange(now);
}

void finished() {
  has_finished.store(true);
  if (answer.load() == Answer::waiting_thread)
    for (;;)
      pause();
}

} // namespace cdem::app::interrupt
