// Solving calls differ in the clock, how nodes move, damping, and when it is enough. The step itself is one
// (step.cpp), whoever makes it.
#pragma once

#include "libcdem/step/stage.hpp"

namespace cdem {

class Procedure {
public:
  Procedure() = default;
  virtual ~Procedure() = default;
  Procedure(const Procedure&) = delete;
  Procedure& operator=(const Procedure&) = delete;

  virtual bool is_over() const = 0;
  virtual double time_step() const = 0; // s; 1 in a relaxation, whose velocities are lengths per step

  // changed: nodes have been freed or joined, or interfaces have other springs. Before a restart point is kept, which is
  // where a stage that goes on begins.
  virtual void begin_step(bool changed, bool joined) = 0;
  virtual std::vector<double> loop_state() = 0;        // for the restart point
  virtual void take_contacts(double longest_step) = 0; // s; they have been evaluated
  virtual void update_loads() = 0;
  // Nodes, all code that reads their positions has run; `force`: of elements and springs, N, beginning with the first.
  virtual void move(Range nodes, const Node* force, NodeSums&) = 0;
  virtual void move_rigid(int rigid, NodeSums&) = 0;
  virtual void place_rigid(int /*rigid*/) {} // its nodes, where it is; in real time only
  virtual void end_step() = 0;               // everything has moved on
  virtual void judge() = 0;                  // the step that has been watched
};

} // namespace cdem
