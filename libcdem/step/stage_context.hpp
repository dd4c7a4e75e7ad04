// What a solving call hands to each of its loops.
#pragma once

#include "libcdem/load/conditions.hpp"
#include "libcdem/results/log.hpp"
#include "libcdem/state/state.hpp"
#include "libcdem/step/checkpoint_writer.hpp"
#include "libcdem/step/observer.hpp"
#include "libcdem/step/restart_point.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace cdem {

struct SeenForces;      // step/support_forces.hpp
struct KeptWork;        // step/kept_work.hpp
struct SlidingFriction; // step/sliding_friction.hpp
std::shared_ptr<SeenForces> nobody_looks();

struct StageContext {
  const Model& model;
  State& state;
  const Conditions& conditions;
  RunLog& log;
  State& last_good; // copy of the state that last passed the watch
  Observer& observer;
  int threads = 1;
  int number = 0;                                       // of the stage, from 1
  CheckpointWriter* checkpoints = nullptr;              // may be null
  std::optional<RestartPoint>* restart_point = nullptr; // written by the stage; null: it can be left nowhere
  const RestartPoint* from = nullptr; // the stage goes on from here; the state is the one of there
  std::function<std::string()> procedure_state{}; // as it is now; empty: a stage of one loop
  // Nodes have other numbers from now on: per node, which it was before. May be empty.
  std::function<void(const std::vector<int>&)> renumbered{};
  std::shared_ptr<SeenForces> seen = nobody_looks(); // filled while somebody looks at the stage
  Model* changing = nullptr; // the model itself, where nodes of cohesive bodies may be freed; null: none are
  // The stage before wrote it, and this one takes it and writes its own where it ends. Null: nothing is kept.
  std::shared_ptr<KeptWork>* kept = nullptr;
  // The end of the run before, where only conditions, strengths or the choice of the step are others since: a stage of one loop,
  // a run or a relaxation, begins anew, and what its first step takes from springs is counted from the springs of there.
  const RestartPoint* before = nullptr;
  SlidingFriction* sliding = nullptr; // of all stages; may be null
};

// The stage can be left here, where none of its loops has begun a step: the RestartPoint is written again. The caller
// keeps the state.
void mark_start_of_loop(const StageContext&);

} // namespace cdem
