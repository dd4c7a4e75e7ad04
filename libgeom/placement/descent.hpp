// Common parts of the descent of a single body (placement/rest.hpp) and of many bodies together
// (placement/rest_together.hpp).
#pragma once

#include "libgeom/core/rotation.hpp"
#include "libgeom/placement/contact_impulses.hpp"
#include "libgeom/placement/rest.hpp"

#include <algorithm>
#include <cassert>

namespace geom {

namespace descent {
inline constexpr double still = 0.03;      // of s: a smaller motion is rest
inline constexpr double smaller = 0.3;     // s after rest, over s before
inline constexpr double tilt = 0.07;       // of gravity, 4 degrees: what rests does so with a margin
inline constexpr int tilts = 4;            // ways it is tilted, by turns
inline constexpr double skin = 3;          // times s: how far the lists of near features reach beyond a step
inline constexpr int pushes = 10;          // at most, to the clear distance
inline constexpr double presses = 0.05;    // of the weight
inline constexpr double more_friction = 2; // times as much: what presses even then is needed
inline constexpr double gives = 0.02;      // of the impulse: touches side by side share the load
} // namespace descent

inline double radius_of(const Features& shape) {
  double radius = 0;
  for (const Vec3& x : shape.corners)
    radius = std::max(radius, x.norm());
  return radius;
}

// Returns how far a point of the body may have gone.
inline double move(Pose& pose, const Motion& v, double gyration, double radius) {
  const Vec3 turn = v.turn / gyration;
  pose.translation += v.shift;
  if (turn.norm() > 0)
    pose.rotation = (rotation_about(turn.normalized(), turn.norm()) * Eigen::Quaterniond(pose.rotation))
                        .normalized()

                        .toRotationMatrix();
  return v.shift.norm() + turn.norm() * radius;
}

// What the impulses of one more step tell of a body at rest: what presses on it, and would with more friction.
inline ImpulseOptions probing(const RestOptions& options, int sweeps) {
  assert(options.probe > 0);
  return {descent::more_friction * options.friction, options.probe, sweeps, descent::gives};
}

// Steps that become smaller while bodies come to rest, under gravity that is tilted by turns.
class Descent {
public:
  explicit Descent(const RestOptions& options)
      : options_(options), aside_(options.down.unitOrthogonal()), other_(options.down.cross(aside_)),
        s(options.step) {}
  Vec3 down(int step) const {
    const Vec3& by = step % 2 == 0 ? aside_ : other_;
    return (options_.down + (step % descent::tilts < 2 ? descent::tilt : -descent::tilt) * by).normalized();
  }
  // Whether a body is at rest that has moved by so much in a step.
  bool at_rest_after(double moved) {
    held_ = moved < descent::still * s ? held_ + 1 : 0;
    if (held_ < descent::tilts)
      return false;
    held_ = 0;
    return at_last();
  }
  // It goes on and on with small steps: takes a larger one.
  void hurry() { s = std::min(s / descent::smaller, options_.step); }
  // It rests with this step; takes a smaller one unless it is the last.
  bool at_last() {
    if (s <= options_.last_step)
      return true;
    s = std::max(descent::smaller * s, options_.last_step);
    return false;
  }

private:
  const RestOptions& options_;
  Vec3 aside_, other_;
  int held_ = 0; // steps in a row

public:
  double s; // m
};

} // namespace geom
