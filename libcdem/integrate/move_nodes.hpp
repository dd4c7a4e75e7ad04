// One step of nodes of which nothing is held, several components side by side: the loops that run once per node.
// Velocities stand half a step before the displacements (central differences).
#pragma once

#include "libcdem/step/workspace.hpp"

namespace cdem {

// Arrays of the nodes that move, first of them first. force: of elements and springs, without loads.
struct MovingNodes {
  const Node* force = nullptr;     // N
  const Node* internal = nullptr;  // N, of the initial stress; null: none
  const Node* external = nullptr;  // N; null: none
  const Node* contact = nullptr;   // N; null: none
  const double* mass = nullptr;    // kg
  const double* viscous = nullptr; // N s/m, mu V; null: none
  Node* velocity = nullptr;        // m/s
  Node* displacement = nullptr;    // m
  std::int64_t count = 0;
};

// The nodes `range` of a model, without viscosity; force points at the first.
MovingNodes moving_nodes(State&, const Workspace&, const std::vector<double>& mass, Range range,
                         const Node* force);

// Of the first node: net force, loads included, and the load in it.
struct HeldForces {
  Node net, load;
};
HeldForces held_node_forces(const MovingNodes&);

struct Stepping {
  double time_step = 0;     // s
  double kick = 0;          // s, from the time of the velocities to half a step ahead
  double local_damping = 0; // fraction of the out-of-balance force
  bool damp_flight = true;  // of rigid bodies without contact forces too
};

// m dv/dt = F - mu V v - alpha |F| sign(v), all at the mean velocity of the step: taken at the velocity before, local
// damping would feed a node that turns round within the step, and blow up near the stable step.
void step_nodes(const MovingNodes&, const Stepping&, NodeSums&);

// m (v+ - v-) = F - c m (v+ + v-) / 2, u += v+, with a unit step. previous_force: N, of the step before; replaced.
void relax_nodes(const MovingNodes&, double damping, Node* previous_force, NodeSums&);

} // namespace cdem
