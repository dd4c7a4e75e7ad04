// One step of a rigid body. The forces on its nodes are summed to a force and a torque about the centroid. Newton's and
// Euler's equations are integrated by central differences (element/rigid_motion.hpp). Then the nodes move with the
// body. As in step_nodes, velocity and angular momentum are half a step before the positions.
#pragma once

#include "libcdem/integrate/move_nodes.hpp"

namespace cdem {

// Loads, and contacts and bonds together, on the nodes of a rigid body, about its centroid.
struct RigidForces {
  geom::Vec3 load = geom::Vec3::Zero(), load_torque = geom::Vec3::Zero();       // N, N m
  geom::Vec3 contact = geom::Vec3::Zero(), contact_torque = geom::Vec3::Zero(); // N, N m
};
RigidForces rigid_forces(const Model&, const State&, const ActingForces&, int rigid);

// Local damping takes alpha |F| off each component of the force, and of the torque in the principal axes, against the
// motion. Viscosity mu takes mu / rho times momentum and angular momentum. Returns how it turns in the step, rad.
geom::Vec3 move_rigid(const Model&, State&, const ActingForces&, int rigid, const Stepping&, NodeSums&);

// Its nodes where the body has moved to, in a step in which it has turned by `angle` (rad): displacements grow by
// velocity x time step (s), the chord of the turn, (R - R_before) / dt = (1 - exp(-angle)) R / dt.
void place_rigid(const Model&, State&, int rigid, const geom::Vec3& angle, double time_step);

// Adds the reaction of a rigid body that is held and does not move, in a relaxation.
void hold_rigid(const Model&, const State&, const ActingForces&, int rigid, NodeSums&);

} // namespace cdem
