// Finds the position at which a rigid body comes to rest among bodies that do not move. It moves down in small steps,
// each from rest, without inertia, until friction holds it.
//
// A step is that of placement/contact_impulses.hpp, which keeps bodies the clear distance apart: v = 0 there is
// equilibrium with friction.
#pragma once

#include "libgeom/placement/features.hpp"

#include <functional>

namespace geom {

struct RestOptions {
  Vec3 down = -Vec3::UnitZ();
  double friction = 0;  // tangent of its angle
  double clear = 0;     // m, distance kept from the others
  double step = 0;      // m, s at first
  double last_step = 0; // m; s is made smaller, down to this, whenever the body has come to rest
  double probe = 0;     // m, > 0: s of the step that tells what presses on a body at rest
  double gyration = 0;  // m, radius of gyration of the body
  int steps = 200;      // at most
  double way = std::numeric_limits<double>::infinity(); // m; a body that has gone further is not followed
  std::function<void()> poll;                           // called every few steps of many bodies; may throw
  // The centroid stays where normal . x >= offset.
  std::vector<Plane> bounds;
};

struct Rest {
  Pose pose;
  bool still = false; // at rest, not stopped after so many steps or so long a way
  std::vector<char>
      carried_by; // at rest: which of the others press on it, with a twentieth of its weight or more
};

// shape: about the body's centroid. Others: closed.
Rest come_to_rest(const Features& shape, const Pose& start, const std::vector<const Features*>& others,
                  const RestOptions&);

// Moved as little as takes it to the clear distance from all others; no gravity, no friction, no bounds.
Pose pushed_clear(const Features& shape, const Pose& start, const std::vector<const Features*>& others,
                  const RestOptions&);

} // namespace geom
