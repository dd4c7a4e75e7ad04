#include "libgeom/placement/contact_impulses.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

constexpr double enough = 1e-3; // of s: when no impulse changes by more, they are found
constexpr int every = 5;        // sweeps: one over all contact points, the others over those that press

ImpulseRow row(const Vec3& direction, const Vec3& arm, const Vec3* other_arm, double gyration) {
  ImpulseRow r{direction, arm.cross(direction) / gyration, Vec3::Zero()};
  r.mass = direction.squaredNorm() + r.turn.squaredNorm();
  if (other_arm != nullptr) {
    r.other_turn = other_arm->cross(direction) / gyration;
    r.mass += direction.squaredNorm() + r.other_turn.squaredNorm();
  }
  return r;
}

double along(const ImpulseRow& r, const Motion& v, const Motion* w) {
  const double one = r.direction.dot(v.shift) + r.turn.dot(v.turn);
  return w == nullptr ? one : one - r.direction.dot(w->shift) - r.other_turn.dot(w->turn);
}

void add(const ImpulseRow& r, double by, Motion& v, Motion* w) {
  v.shift += by * r.direction;
  v.turn += by * r.turn;
  if (w != nullptr) {
    w->shift -= by * r.direction;
    w->turn -= by * r.other_turn;
  }
}

// Returns by how much the impulse has changed.
double push(ImpulseRow& r, double to, Motion& v, Motion* w) {
  const double change = to - r.impulse;
  add(r, change, v, w);
  r.impulse = to;
  return std::abs(change);
}

double press(ImpulseRow& r, double room, double gives, Motion& v, Motion* w) {
  const double now = r.impulse - (along(r, v, w) + room + gives * r.impulse) / (r.mass + gives);
  return push(r, std::max(0., now), v, w);
}

// Returns by how much an impulse has changed at most.
double meet(BodyTouch& touch, std::vector<Motion>& all, const ImpulseOptions& options) {
  Motion& v = all[touch.body];
  Motion* const w = touch.other < 0 ? nullptr : &all[touch.other];
  const double gives = options.compliance;
  const double change = press(touch.normal, std::max(touch.room, -options.step), gives, v, w);
  ImpulseRow &first = touch.first, &second = touch.second;
  if (touch.normal.impulse == 0 && first.impulse == 0 && second.impulse == 0)
    return change;
  double a = first.impulse - (along(first, v, w) + gives * first.impulse) / (first.mass + gives);
  double b = second.impulse - (along(second, v, w) + gives * second.impulse) / (second.mass + gives);
  const double held = options.friction * touch.normal.impulse, square = a * a + b * b;
  if (square > held * held) {
    const double part = held / std::sqrt(square);
    a *= part;
    b *= part;
  }
  return std::max({change, push(first, a, v, w), push(second, b, v, w)});
}

} // namespace

BodyTouch body_touch(const Touch& touch, int body, int other, const Centroids& centroids, double gyration) {
  const Vec3 &n = touch.normal, arm = touch.point - centroids.body, other_arm = touch.point - centroids.other;
  const Vec3 t = (std::abs(n.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY()).cross(n).normalized();
  const Vec3* const there = other < 0 ? nullptr : &other_arm;
  return {body,
          other,
          row(n, arm, there, gyration),
          row(t, arm, there, gyration),
          row(n.cross(t), arm, there, gyration),
          touch.gap,
          touch.features};
}

BodyBound body_bound(const Plane& plane, int body, const Vec3& centroid) {
  return {body, row(plane.normal, Vec3::Zero(), nullptr, 1), plane.level(centroid)};
}

std::vector<Motion> motions(std::vector<BodyTouch>& touches, std::vector<BodyBound>& bounds,
                            std::size_t bodies, const Vec3& pull, const ImpulseOptions& options) {
  std::vector<Motion> all(bodies, Motion{pull, Vec3::Zero()});
  for (BodyTouch& touch : touches)
    for (ImpulseRow* row : {&touch.normal, &touch.first, &touch.second})
      add(*row, row->impulse, all[touch.body], touch.other < 0 ? nullptr : &all[touch.other]);
  std::vector<BodyTouch*> pressing;
  pressing.reserve(touches.size());
  bool over_all = true;
  for (int k = 0; k < options.sweeps; ++k) {
    double most = 0;
    for (BodyBound& bound : bounds)
      most =
          std::max(most, press(bound.row, std::max(bound.room, -options.step), 0, all[bound.body], nullptr));
    // To and fro where there are many: weight goes down through all of them in one sweep if they are listed from the
    // top.
    if (over_all) {
      pressing.clear();
      for (BodyTouch& touch : touches) {
        most = std::max(most, meet(touch, all, options));
        if (touch.normal.impulse > 0)
          pressing.push_back(&touch);
      }
    } else if (bodies == 1 || k % 2 == 0) {
      for (BodyTouch* touch : pressing)
        most = std::max(most, meet(*touch, all, options));
    } else {
      for (auto touch = pressing.rbegin(); touch != pressing.rend(); ++touch)
        most = std::max(most, meet(**touch, all, options));
    }
    const bool found = most < enough * options.step;
    if (found && over_all)
      break;
    over_all = found || (k + 1) % every == 0;
  }
  return all;
}

} // namespace geom
