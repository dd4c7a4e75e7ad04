#include "libgeom/placement/rest.hpp"

#include "libgeom/placement/descent.hpp"

#include <algorithm>
#include <cmath>

namespace geom {
namespace {

constexpr int sweeps = 60; // over all impulses, at most

std::vector<BodyTouch> touches_of(const std::vector<Touch>& touches, const Vec3& centroid,
                                  const RestOptions& options) {
  std::vector<BodyTouch> made;
  made.reserve(touches.size());
  for (const Touch& touch : touches) {
    made.push_back(body_touch(touch, 0, -1, {centroid, centroid}, options.gyration));
    made.back().room -= options.clear;
  }
  return made;
}

Motion step(std::vector<BodyTouch>& touches, std::vector<BodyBound>& bounds, double friction,
            const Vec3& pull, double s) {
  return motions(touches, bounds, 1, pull, {friction, s, sweeps}).front();
}

// Which of the others carry a body at rest.
std::vector<char> carriers(const Features& body, const Vec3& centroid,
                           const std::vector<const Features*>& others, const RestOptions& options) {
  const ImpulseOptions probing = geom::probing(options, sweeps);
  const double reach = 2 * probing.step + options.clear;
  std::vector<Touch> found;
  std::vector<std::size_t> of; // the other of each touch
  for (std::size_t i = 0; i < others.size(); ++i) {
    NearFeatures(body, *others[i], reach).touches(body, *others[i], reach, found);
    of.resize(found.size(), i);
  }
  std::vector<BodyTouch> touches = touches_of(found, centroid, options);
  for (BodyTouch& touch : touches) // what pushes it out of another does not carry it
    touch.room = std::max(0., touch.room);
  std::vector<BodyBound> no_bounds;
  motions(touches, no_bounds, 1, probing.step * options.down, probing);
  std::vector<double> impulse(others.size(), 0);
  for (std::size_t i = 0; i < touches.size(); ++i)
    impulse[of[i]] += touches[i].normal.impulse;
  std::vector<char> carry(others.size());
  for (std::size_t i = 0; i < others.size(); ++i)
    carry[i] = impulse[i] > descent::presses * probing.step ? 1 : 0;
  return carry;
}

} // namespace

Rest come_to_rest(const Features& shape, const Pose& start, const std::vector<const Features*>& others,
                  const RestOptions& options) {
  Rest rest{start, false, {}};
  Descent descent(options);
  double gone = std::numeric_limits<double>::infinity(), skin = 0;
  const double radius = radius_of(shape);
  std::vector<NearFeatures> near(others.size());
  std::vector<Touch> found;
  for (int k = 0; k < options.steps; ++k) {
    const Features body = moved(shape, rest.pose);
    const double s = descent.s, reach = 2 * s + options.clear;
    if (gone > skin) {
      skin = descent::skin * s;
      gone = 0;
      for (std::size_t i = 0; i < others.size(); ++i)
        near[i] = NearFeatures(body, *others[i], reach + skin);
    }
    found.clear();
    for (std::size_t i = 0; i < others.size(); ++i)
      near[i].touches(body, *others[i], reach, found);
    std::vector<BodyTouch> touches = touches_of(found, rest.pose.translation, options);
    std::vector<BodyBound> bounds;
    for (const Plane& plane : options.bounds)
      bounds.push_back(body_bound(plane, 0, rest.pose.translation));

    const Motion v = step(touches, bounds, options.friction, s * descent.down(k), s);
    gone += move(rest.pose, v, options.gyration, radius);
    if ((rest.pose.translation - start.translation).norm() > options.way)
      break;
    if (!descent.at_rest_after(v.norm()))
      continue;
    rest.still = true;
    rest.carried_by = carriers(moved(shape, rest.pose), rest.pose.translation, others, options);
    break;
  }
  return rest;
}

Pose pushed_clear(const Features& shape, const Pose& start, const std::vector<const Features*>& others,
                  const RestOptions& options) {
  Pose pose = start;
  RestOptions smooth = options;
  smooth.friction = 0;
  smooth.clear = 1.001 * options.clear;
  std::vector<BodyBound> no_bounds;
  for (int k = 0; k < descent::pushes; ++k) {
    const Features body = moved(shape, pose);
    const double reach = 2 * options.clear;
    std::vector<Touch> touches;
    for (const Features* other : others)
      NearFeatures(body, *other, reach).touches(body, *other, reach, touches);
    if (std::all_of(touches.begin(), touches.end(),
                    [&](const Touch& touch) { return touch.gap >= options.clear; }))
      break;
    std::vector<BodyTouch> pressing = touches_of(touches, pose.translation, smooth);
    move(pose, step(pressing, no_bounds, 0, Vec3::Zero(), options.clear), options.gyration, 0);
  }
  return pose;
}

} // namespace geom
