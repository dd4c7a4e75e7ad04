// A model with its state, its conditions and its log: what solving calls advance, and what a script changes between them.
#pragma once

#include "libcdem/fracture/rebuild.hpp"
#include "libcdem/load/conditions.hpp"
#include "libcdem/ranks/state_shares.hpp"
#include "libcdem/results/log.hpp"
#include "libcdem/step/observer.hpp"
#include "libcdem/step/restart_point.hpp"
#include "libcdem/step/sliding_friction.hpp"
#include "libcdem/step/stage_context.hpp"

#include <array>
#include <memory>
#include <optional>

namespace cdem {

struct SimulatedModel {
  Model model;
  std::uint64_t built = 0; // hash of the model as it was built
  // In a stage among several ranks: the share of this one, until somebody looks at more. Gathering it changes no value.
  mutable State kept;
  State last_good;
  Conditions conditions;
  RunLog log;
  SlidingFriction sliding;
  std::shared_ptr<Observer> observer;
  int threads = 1;
  int stage = 0;            // solving calls so far, with the one that runs
  double last_residual = 0; // of the last of them
  // A script is answered from its journal up to its checkpoint: the model that it speaks of is not there yet.
  bool replaying = false;

  std::shared_ptr<SeenForces> seen = nobody_looks(); // of the last stage

  // Where the last run ended, with the state in last_good: a run that follows goes on from there, with the steps that the
  // last one chose, if it is to choose them in the same way. Null: the state has been changed since, or solved otherwise.
  using StepChoice = std::array<double, 4>; // of RunOptions: safety, time_step, mass_scaling
  struct End {
    RestartPoint point;
    StepChoice step_choice{};
    bool with_other_conditions = false; // those of now, or other strengths
  };
  std::optional<End> end_of_run;
  std::shared_ptr<KeptWork> work; // of the last stage; null: none is kept

  // All ranks call these together.
  const State& whole() const {
    make_whole(kept);
    return kept;
  }
  void change_conditions() {
    if (end_of_run)
      end_of_run->with_other_conditions = true;
  }
  State& changing() {
    end_of_run.reset();
    make_whole(kept);
    return kept;
  }
  // A change of topology between stages: the ledger counts what it does to the stored and the kinetic energy.
  void adopt(Rebuilt&&);
};

} // namespace cdem
