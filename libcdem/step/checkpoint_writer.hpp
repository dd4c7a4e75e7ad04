// Who writes checkpoints while a stage runs. Nothing it does may change the state.
#pragma once

namespace cdem {

class CheckpointWriter {
public:
  virtual ~CheckpointWriter() = default;
  virtual void marked() {}                 // the stage can be left at the step it has reached
  virtual bool wanted() { return false; }  // polled every few steps: write one now
  virtual void write(bool /*stopping*/) {} // stopping: the stage ends now, by Interrupted
};

} // namespace cdem
