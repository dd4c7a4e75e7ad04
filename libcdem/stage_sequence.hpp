// The solving calls of a simulation, in order. Each is a numbered stage. A stage that was left goes on from its restart
// point when the same call is made again; a run goes on from where the run before ended, if nothing has changed since.
//
// A simulation is saved with the place that its stages have reached.
#pragma once

#include "libcdem/simulated_model.hpp"
#include "libcdem/simulation_warnings.hpp"
#include "libcdem/step/stage_context.hpp"

#include <string_view>

namespace cdem {

class StageSequence {
public:
  StageSequence(SimulatedModel& of, Warnings& warnings) : of_(of), warnings_(warnings) {}

  using Solve = std::function<void(const StageContext&)>;
  // One stage, from where it was left if it was. step_choice: of a run.
  void run(const Solve&, const std::optional<SimulatedModel::StepChoice>& step_choice = {});
  // One that begins again when it was left, as it changes the model from step to step.
  void run_whole(const Solve&);

  // As Simulation's.
  std::string save() const;
  void gather_to_save();
  void restore(std::string_view saved, bool state_only);
  void set_writer(CheckpointWriter* writer) { checkpoints_ = writer; }

private:
  StageContext next();
  void gather_springs(RestartPoint&) const; // of the shares of last_good
  RestartPoint take_up(RestartPoint);

  SimulatedModel& of_;
  Warnings& warnings_;
  CheckpointWriter* checkpoints_ = nullptr;
  bool in_stage_ = false;                     // that the model's number counts already
  std::optional<RestartPoint> restart_point_; // of the stage that runs
  std::optional<RestartPoint> from_;          // of a restored stage, until it is taken up
  std::string at_start_; // saved before a stage that can only begin again; empty: none runs
};

} // namespace cdem
