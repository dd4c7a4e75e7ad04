// How a stage that runs is left and taken up again, to the same bits as one that was never left.
//
// Every watch_every steps a stage has brought everything up to one moment and copied its state (Stage::mark). From
// there it can go on: the state is in last_good, what the loop carries besides in the Moment. A stage of several loops
// (settle, critical_flow) can be left in each of them and where one begins.
#pragma once

#include "libcdem/parallel/node.hpp"
#include "libgeom/core/types.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace cdem {

struct Moment {
  std::int64_t step = 0;                                           // within the stage; 0: its start
  std::size_t breaks = 0;                                          // in the log so far
  double wall_time = 0;                                            // s, of the stage so far
  std::int64_t broken_tension_before = 0, broken_shear_before = 0; // when the stage began
  std::vector<double> carried;                                     // numbers of the stage's own loop
  std::vector<Node> previous_force;                                // N, of a relaxation (n_nodes)
  // Those of the BondWork: what broken and softening springs lose is counted from the step before.
  std::vector<geom::Vec3> spring_force, stretch; // N, m (n_points)
  // Of a stage of several loops: what it carries beside them, and which of them runs, as it has written it itself.
  std::string beside;
};

// Who writes checkpoints while a stage runs. Nothing it does may change the state.
class Keeper {
public:
  virtual ~Keeper() = default;
  virtual void marked() {}                 // the stage can be left at the step it has reached
  virtual bool wanted() { return false; }  // polled every few steps: write one now
  virtual void write(bool /*stopping*/) {} // stopping: the stage ends now, by Interrupted
};

} // namespace cdem
