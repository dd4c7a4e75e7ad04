// What relaxing and running share: the parts of a step that go over all chunks, and the watch over a stage.
#pragma once

#include "libcdem/results/log.hpp"
#include "libcdem/step/observer.hpp"
#include "libcdem/step/workspace.hpp"

#include <chrono>
#include <functional>

namespace cdem {

struct StageContext {
  const Model& model;
  State& state;
  const Conditions& conditions;
  RunLog& log;
  State& last_good; // copy of the state that last passed the watch
  Observer& observer;
  int threads = 1;
  int number = 0; // of the stage, from 1
};

class Stage {
public:
  // run_away: displacement that ends the stage with a SolutionError, m.
  Stage(StageContext context, std::string kind, double run_away);
  ~Stage() { catch_up(); }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  Workspace work;
  std::int64_t step = 0; // within the stage

  // Springs between faces and parts of meshes: all that pulls at nodes of more than one chunk.
  void shared_forces(bool breaking);
  // Brings the stress of meshes up to where the nodes are; before a state is kept or handed out.
  void catch_up();
  // body(chunk index, chunk) -> NodeSums over all chunks; returns the total, summed in order.
  template <class Body>
  NodeSums over_chunks(const Body& body) {
    for_chunks(static_cast<std::int64_t>(context_.model.chunks.size()), context_.threads,
               [&](std::int64_t c) { work.node_sums[c] = body(context_.model.chunks[c]); });
    return total();
  }

  // Bookkeeping after a step: ledger, breaks, history, progress, watch, stop. Throws SolutionError, Interrupted.
  struct StepReport {
    NodeSums sums;
    double residual = 0;
    Progress goals; // residual_goal, time_goal, max_steps
  };
  void after_step(const StepReport&);
  void finish(const StepReport&); // last history row and progress
  std::int64_t broken_in_step() const { return broken_in_step_; }
  std::int64_t broken_tension() const { return context_.log.broken_tension - broken_tension_before_; }
  std::int64_t broken_shear() const { return context_.log.broken_shear - broken_shear_before_; }
  double wall_time() const; // s

private:
  NodeSums total() const;
  void record_breaks();
  void record_face_breaks();
  void record_history(const StepReport&);
  void keep_state();
  void watch() const;
  void tell(const StepReport&, bool last);

  StageContext context_;
  std::string kind_;
  double run_away_;
  std::int64_t broken_in_step_ = 0;
  std::int64_t broken_tension_before_ = 0, broken_shear_before_ = 0;
  std::chrono::steady_clock::time_point start_, told_;
  std::int64_t told_step_ = 0;
};

// Of the threads allowed, as many as the model keeps busy.
int useful_threads(const Model&, int threads);

// Out-of-balance over applied force norm; reactions stand in for the loads where supports move.
double relative_residual(const NodeSums&);

} // namespace cdem
