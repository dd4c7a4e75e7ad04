#include "tests/bench/measure.hpp"

#include "libcdem/procedure/run.hpp"

#include <cmath>
#include <ctime>
#include <fstream>
#include <malloc.h>
#include <unistd.h>

namespace bench {

using namespace cdem;

double resident_bytes() {
  malloc_trim(0);
  std::ifstream statm("/proc/self/statm");
  double pages = 0, resident = 0;
  statm >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double Stopwatch::now() const {
  timespec t{};
  clock_gettime(own_ ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

namespace {

struct FirstStep : Observer {
  const Stopwatch* watch = nullptr;
  double seconds = -1;
  void progress(const Progress& p) override {
    if (seconds < 0 && p.step == 1)
      seconds = watch->seconds();
    if (p.last)
      times = p.times;
    else if (memory)
      *memory = resident();
  }
  std::string times;
  Resident* memory = nullptr;
};

} // namespace

State shaken(const Model& model) {
  State state = initial_state(model);
  for (std::size_t i = 0; i < state.velocity.size(); ++i)
    state.velocity[i].x = 1e-3 * std::sin(static_cast<double>(i));
  return state;
}

double stepping_seconds(const Model& model, State& state, int threads, std::int64_t steps, bool by_clock,
                        std::string* times, Resident* memory) {
  const Conditions none;
  RunLog log;
  State last_good;
  const Stopwatch watch(by_clock ? 2 : threads);
  FirstStep first;
  first.watch = &watch;
  first.memory = memory;
  double last = 0; // s
  RunOptions options;
  options.steps = steps + 1;
  options.callback_every =
      steps + 1; // once: what callbacks read has to be brought to one moment, a kernel's work
  options.callback = [&] { last = watch.seconds(); };
  run({model, state, none, log, last_good, first, threads, 1}, options);
  if (times)
    *times = first.times;
  return last - first.seconds;
}

double step_rate(const Model& model, int threads, double at_least, std::string* times) {
  State state = shaken(model);
  return rate(at_least,
              [&](std::int64_t n) { return stepping_seconds(model, state, threads, n, false, times); });
}

} // namespace bench
