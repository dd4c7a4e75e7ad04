// Rotation of a rigid body: R its rotation since it was made rigid, I its inertia in the directions it had then, L its
// angular momentum about the centroid, which only a torque changes:
//   dR/dt = [w] R,  w = R I^-1 R^T L
// Half a step ahead of R_n the spin is the one that brings R there (implicit midpoint), and the step is one turn:
//   w = R_h I^-1 R_h^T L,  R_h = exp([w] dt / 2) R_n,  R_n+1 = exp([w] dt) R_n
// exact where the spin does not change, else of second order and without drift of the energy; read backwards it is the
// same step. L is kept to the last bit.
#pragma once

#include "libcdem/model/model.hpp"
#include "libcdem/state/rigid_state.hpp"

namespace cdem {

geom::Vec3 vec(const std::array<double, 3>&);
std::array<double, 3> three_of(const geom::Vec3&);

geom::Mat3 rotation(const RigidState&);   // R
geom::Mat3 turn(const geom::Vec3& angle); // exp of the cross product with a rotation vector, rad
// exp - 1, without the loss of digits of small angles.
geom::Mat3 turn_less_one(const geom::Vec3& angle);
void turn_by(RigidState&, const geom::Vec3& angle); // of a unit quaternion, which stays one

// rad/s, at `ahead` s (which may be negative) from the rotation; not a number for a spin of a radian or more in that
// time, which the step is too coarse for.
geom::Vec3 spin(const RigidBody&, const RigidState&, double ahead);

// J, of velocity and angular momentum that stand `lag` s before the rotation.
double kinetic_energy(const RigidBody&, const RigidState&, double lag);

} // namespace cdem
