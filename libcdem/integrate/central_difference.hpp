// Central differences: velocities stand half a step before the displacements.
//
//   m dv/dt = F - c v - alpha |F| sign(v)          u+ = u + dt v+
//
// The viscosity c and local damping alpha act on the mean velocity of the step: taken at the velocity before, local
// damping would feed what turns round within the step, and blow up near the stable step. With the inertia m / dt,
//
//   v* = ((m/dt - c/2) v- + F) / (m/dt + c/2)      without local damping
//   v+ = v* -+ alpha |F| / (m/dt + c/2)            against v- + v*, and at rest on the mean where it could be held there
//
// One component, written for any number type: `double`, or several values at a time. For a rigid body m is its mass, or
// a principal moment of inertia with angular velocity and torque.
#pragma once

#include "libcdem/parallel/node.hpp"

namespace cdem::central_difference {

// inertia: m / dt, kg/s.
template <class Number>
CDEM_INLINE Number velocity_after(const Number& before, const Number& force, double inertia) {
  return before + force * (1 / inertia);
}

template <class Number>
struct Damped {
  Number velocity; // m/s, after
  Number lost;     // W, to damping; over the time of the step J
};

// viscous: c, N s/m.
template <class Number>
CDEM_INLINE Damped<Number> velocity_after(const Number& before, const Number& force, double inertia,
                                          double viscous, double local_damping) {
  const Number zero{};
  const double half = 0.5 * viscous, heavy = inertia + half, inverse = 1 / heavy;
  const Number undamped = ((inertia - half) * before + force) * inverse;
  const Number most =
      local_damping * inverse * (force < zero ? zero - force : force); // can take off the velocity
  const Number both = before + undamped;
  Damped<Number> after;
  after.velocity = both > most ? undamped - most : both < zero - most ? undamped + most : zero - before;
  const Number against = heavy * (undamped - after.velocity), mean = 0.5 * (before + after.velocity);
  after.lost = (viscous * mean + against) * mean;
  return after;
}

} // namespace cdem::central_difference
