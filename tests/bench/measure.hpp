// What the benchmarks share: rates, memory, and the solver's own step from outside.
#pragma once

#include "libcdem/load/conditions.hpp"
#include "libcdem/parallel/residency.hpp"
#include "libcdem/state/state.hpp"
#include "tests/bench/bench.hpp"

#include <string>

namespace bench {

double resident_bytes(); // of this process, after what was freed is given back

// Of one thread its processor time, which other programs on the machine do not lengthen; of more the time on the wall.
class Stopwatch {
public:
  explicit Stopwatch(int threads) : own_(threads == 1), start_(now()) {}
  double seconds() const { return now() - start_; }

  double now() const;

private:
  bool own_;
  double start_;
};

// Repetitions per second; `repeat(n)` returns how long n of them took, n raised until that is long enough.
template <class Repeat>
double rate(double at_least, const Repeat& repeat) {
  for (std::int64_t n = 1;; n *= 2) {
    const double seconds = repeat(n);
    if (seconds >= at_least)
      return static_cast<double>(n) / seconds;
  }
}

cdem::State shaken(const cdem::Model&); // at velocities far below what breaks a bond

// Of a step of `run`, breaking on. From the first step to the last: what a stage does once, at its start and end, is left
// out. All is this rank's.
struct Stepped {
  double clock = 0, processor = 0; // s; the latter of this thread, without waiting for other ranks
  double messages = 0, bytes = 0;  // that it sends
  double waited = 0;               // share of the clock
  cdem::Resident memory{};         // between two steps, when it was last asked
  std::string times{};             // where the time of all steps went, by lines of the step
};
Stepped stepped(const cdem::Model&, const cdem::Conditions&, cdem::State&, int threads, std::int64_t steps);

// Steps per second of a shaken model.
double step_rate(const cdem::Model&, int threads, double at_least, std::string* times = nullptr);

} // namespace bench
