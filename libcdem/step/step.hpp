// The step of all solving calls. What they differ in is a Procedure (procedure/run.cpp, procedure/relax.cpp).
#pragma once

#include "libcdem/step/stage.hpp"

namespace cdem {

// What a solving call adds to the step: how long it is, how nodes move, and what is looked at after it.
class Procedure {
public:
  virtual ~Procedure() = default;

  virtual bool breaks() const = 0;      // bonds do
  virtual bool joins() const = 0;       // freed nodes again
  virtual double time_step() const = 0; // s; 1 in a relaxation, whose velocities are lengths per step
  // Nodes have been freed or joined, or interfaces have other springs.
  virtual void take_changed_model(bool joined) = 0;
  virtual void choose_step(bool /*changed*/) {}
  virtual void keep_restart_point() = 0;
  virtual void update_contacts() = 0;
  virtual void update_loads() = 0;
  virtual void advance() = 0;  // Stage::advance
  virtual void end_step() = 0; // everything has moved on; what the watch is told
  virtual void look() = 0;     // callbacks, and whether the stage is at its end

  Stage::StepReport report;
};

void make_step(Stage&, Procedure&);

} // namespace cdem
