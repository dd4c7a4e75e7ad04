// One step of nodes of which nothing is held, several components side by side: the loops that run once per node.
// Velocities stand half a step before the displacements (central differences).
#pragma once

#include "libcdem/integrate/contact_on_rigid.hpp"
#include "libcdem/load/resolve.hpp"

namespace cdem {

// Sums of one chunk of blocks, over its free degrees of freedom.
struct NodeSums {
  double residual2 = 0;  // N2, out-of-balance forces
  double applied2 = 0;   // N2, external forces
  double reaction2 = 0;  // N2, out-of-balance forces where nodes are held
  double stiffness = 0;  // J, -du . dF
  double inertia = 0;    // J, du . M du
  double kinetic = 0;    // J
  double external = 0;   // J, this step
  double damping = 0;    // J, this step
  double radiated = 0;   // J, this step, by dashpots
  double fictitious = 0; // J, this step, by leading nodes with supports
  // N2, as the first and the third, weighted by how fast nodes move with supports (procedure/support_way.hpp).
  double led_residual2 = 0, led_reaction2 = 0;
};

// What acts on nodes beside the stress of elements.
struct ActingForces {
  const ResolvedConditions& resolved;
  const std::vector<Node>& contact; // N, of contacts, where nodes deform (n_nodes); empty without
  const std::vector<ContactOnRigid>& contact_on_rigid; // per rigid body; empty without
  const std::vector<geom::Vec3>& bond;                 // N, of springs of interfaces on side a (n_points)
  const std::vector<char>& idle_blocks; // per block: no spring acts on it; empty without interfaces that turn
};

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
MovingNodes moving_nodes(State&, const ActingForces&, const std::vector<double>& mass, Range range,
                         const Node* force);

// Forces of the first node, N: the net force, loads included, and the load in it.
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

// By central differences (integrate/central_difference.hpp), c = mu V.
void step_nodes(const MovingNodes&, const Stepping&, NodeSums&);

// By dynamic relaxation (integrate/dynamic_relaxation.hpp). previous_force: N, of the step before; replaced.
void relax_nodes(const MovingNodes&, double damping, Node* previous_force, NodeSums&);

} // namespace cdem
