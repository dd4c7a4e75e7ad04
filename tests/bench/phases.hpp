// A model that breaks while it runs, in phases: how fast each steps beside the first, in which it is whole.
#pragma once

#include "libcdem/procedure/run.hpp"
#include "tests/bench/measure.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace bench {

// Steps that a whole body with so many tets makes in some `seconds` on one thread.
std::int64_t steps_of_whole(std::size_t tets, double seconds);

// The columns of a phase.
void print_head_of_phases(const char* title);

class Phases {
public:
  static constexpr int ask_every = 20; // steps

  // label: of the rows.
  Phases(std::string label, cdem::Model model);

  cdem::Model model;
  cdem::State state;
  cdem::Conditions conditions;
  cdem::RunLog log;

  // Runs until ends(), asked every few steps, or for most_steps, and prints a row. The clock ends no phase: what breaks would
  // depend on it.
  void run(const char* name, std::int64_t most_steps, const std::function<bool()>& ends);

private:
  std::string label_;
  cdem::State last_good_;
  std::optional<cdem::RestartPoint> restart_point_; // passed as often as in the run of a script
  double start_ = 0, whole_ = 0;                    // J; steps a second
  int stage_ = 0;
};

} // namespace bench
