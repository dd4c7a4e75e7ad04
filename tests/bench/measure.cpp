#include "tests/bench/measure.hpp"

#include "libcdem/procedure/run.hpp"
#include "libcdem/ranks/ranks.hpp"

#include <cmath>
#include <ctime>
#include <fstream>
#include <malloc.h>
#include <optional>
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

struct Moment {
  double clock = Stopwatch(2).now(), processor = Stopwatch(1).now(); // s
  Ranks::Traffic traffic = ranks().traffic();
};

struct FirstStep : Observer {
  std::optional<Moment> at;
  void progress(const Progress& p) override {
    if (!at && p.step == 1)
      at.emplace();
    if (p.last)
      times = p.times;
    else
      memory = resident();
  }
  std::string times;
  Resident memory;
};

} // namespace

State shaken(const Model& model) {
  State state = initial_state(model);
  for (std::size_t i = 0; i < state.velocity.size(); ++i)
    state.velocity[i].x = 1e-3 * std::sin(static_cast<double>(i));
  return state;
}

Stepped stepped(const Model& model, const Conditions& conditions, State& state, int threads,
                std::int64_t steps) {
  RunLog log;
  State last_good;
  FirstStep first;
  Moment last;
  RunOptions options;
  options.steps = steps + 1;
  options.callback_every =
      steps + 1; // once: what callbacks read has to be brought to one moment, a kernel's work
  options.callback = [&] { last = Moment(); };
  run({model, state, conditions, log, last_good, first, threads, 1}, options);
  const auto n = static_cast<double>(steps);
  const Ranks::Traffic &before = first.at->traffic, &after = last.traffic;
  const double clock = last.clock - first.at->clock;
  return {clock / n,
          (last.processor - first.at->processor - (after.waited_processor - before.waited_processor)) / n,
          static_cast<double>(after.messages - before.messages) / n,
          static_cast<double>(after.bytes - before.bytes) / n,
          (after.waited - before.waited) / clock,
          first.memory,
          first.times};
}

double step_rate(const Model& model, int threads, double at_least, std::string* times) {
  State state = shaken(model);
  return rate(at_least, [&](std::int64_t n) {
    const Stepped one = stepped(model, {}, state, threads, n);
    if (times)
      *times = one.times;
    return static_cast<double>(n) * (threads == 1 ? one.processor : one.clock);
  });
}

} // namespace bench
