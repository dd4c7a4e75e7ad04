// Where the time of a step goes: each line of the step is timed from the end of the line before, with one reading of the
// processor's counter, some nanoseconds.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>

namespace cdem {

// The lines of a step, in their order (step/step.cpp).
enum class StepLine {
  contact_search, // contacts, in the steps that search anew
  contacts,       // in all others
  loads,
  cracks,       // cohesive bodies: nodes freed, faces turned to their law
  bonds,        // springs between blocks
  elements,     // with bonds inside meshes, and the motion of the nodes of one chunk alone
  shared_nodes, // sums over chunks, and the motion of the nodes of several
  rigid_bodies,
  ranks,  // values and sums that ranks tell each other at the end of a step
  watch,  // energies, breaks, soundness, histories
  others, // between two steps: callbacks, checkpoints, progress
};
constexpr std::size_t step_lines = 11;
const char* name(StepLine);

class StepTimes {
public:
  // What has passed since the line before belongs to this one.
  void end(StepLine line) {
    const std::int64_t now = ticks();
    spent_[static_cast<std::size_t>(line)] += now - last_;
    last_ = now;
  }
  double share(StepLine) const; // of all time so far, 0 .. 1
  // "elements 71 %, bonds 20 %, watch 5 %": the largest first, those below 1 % left out.
  std::string text() const;

private:
  static std::int64_t ticks() {
#if defined(__x86_64__)
    return static_cast<std::int64_t>(__builtin_ia32_rdtsc());
#else
    return std::chrono::steady_clock::now().time_since_epoch().count();
#endif
  }
  std::array<std::int64_t, step_lines> spent_{};
  std::int64_t last_ = ticks();
};

} // namespace cdem
