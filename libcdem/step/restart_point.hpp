// A point at which a running stage can be left, and continued later with the same bits as without the interruption.
//
// Every watch_every steps of the model a stage synchronises everything and copies its state (Stage::keep_restart_point). It also does so
// where its model has become another one, without synchronising anything: what breaks in one body is no event of others.
// From there it can go on: the state is in last_good, and what the loop carries besides in the RestartPoint. A stage of several loops
// (settle, critical_flow) can be left in each of them and where one begins.
//
// The end of a run is such a point too: the state as the last step left it, before it is synchronised for results. A run that
// follows with nothing but looks in between goes on from there (Simulation::run).
#pragma once

#include "libcdem/load/flow_patterns.hpp"
#include "libcdem/parallel/node.hpp"
#include "libcdem/results/one_way_energies.hpp"
#include "libcdem/step/sliding_friction.hpp"
#include "libgeom/core/types.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace cdem {

struct RestartPoint {
  std::int64_t step = 0;  // within the stage; 0: its start
  bool begun = false;     // steps have been made, in this stage or the one it goes on from
  std::size_t breaks = 0; // in the log so far
  double wall_time = 0;   // s, of the stage so far
  std::int64_t broken_tension_before = 0, broken_shear_before = 0; // when the stage began
  std::vector<double> loop_state;                                  // numbers of the stage's own loop
  std::vector<std::vector<Node>> carried;                          // Stage::carried (n_nodes each)
  // Those of the BondWork: what broken and softening springs lose is counted from the step before.
  std::vector<geom::Vec3> spring_force, stretch, viscous; // N, m, N (n_points)
  OneWayEnergies one_way;                                 // in the log so far
  double contact_step = 0;        // s, the last time step: how thick the skins of the search are goes with it
  double strain_step = 0;         // s, Workspace::strain_step
  std::vector<std::uint8_t> near; // NearStrength::bits; empty: unknown
  std::vector<int> slid;          // interfaces to renew before the next step
  FlowPatterns flows;             // as they were found last
  SlidingFriction sliding;
  // For a stage of several loops: the data of the procedure around the loops, and the number of the running loop, as
  // the procedure has written them.
  std::string procedure_state;
};

} // namespace cdem
