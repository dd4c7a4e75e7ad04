// One step of contact dynamics (Moreau 1988) that begins at rest: the motions v of bodies, each pulled by s along
// gravity. Impulses act at all contact points within reach such that normal . v + clearance >= 0. No impulse pulls, and
// friction prevents sliding up to mu times the normal impulse. The impulses are computed one by one in turn (projected
// Gauss-Seidel).
//
// All bodies have the same mass, and the same radius of gyration about all axes.
#pragma once

#include "libgeom/placement/features.hpp"

namespace geom {

struct Motion {
  Vec3 shift = Vec3::Zero(), turn = Vec3::Zero(); // m; the turn times the radius of gyration
  double norm() const { return std::sqrt(shift.squaredNorm() + turn.squaredNorm()); }
};

// One direction at a point of one body or two, in which an impulse acts: on the first along it, on the second against
// it.
struct ImpulseRow {
  Vec3 direction, turn, other_turn;
  double mass = 0; // inverse: motion along the direction per impulse
  double impulse = 0;
};

struct BodyTouch {
  int body = 0, other = -1;         // indices of motions; -1: what does not move
  ImpulseRow normal, first, second; // the last two along the face
  double room = 0;                  // m, until it touches
  std::uint64_t features = 0;       // of the Touch
};

// A centroid stays where direction . x >= an offset.
struct BodyBound {
  int body = 0;
  ImpulseRow row;
  double room = 0; // m
};

struct Centroids {
  Vec3 body, other; // m
};
BodyTouch body_touch(const Touch&, int body, int other, const Centroids&, double gyration);
BodyBound body_bound(const Plane&, int body, const Vec3& centroid);

struct ImpulseOptions {
  double friction = 0;   // tangent of its angle
  double step = 0;       // m, s
  int sweeps = 60;       // over all impulses, at most
  double compliance = 0; // m per m of impulse: compliance of a contact point, along the face too
};

// Motions of all bodies. The impulses are written into the rows of the contact points; their starting values are read
// there. Contact points and bounds deeper than a step count as one step deep.
std::vector<Motion> motions(std::vector<BodyTouch>&, std::vector<BodyBound>&, std::size_t bodies,
                            const Vec3& pull, const ImpulseOptions&);

} // namespace geom
