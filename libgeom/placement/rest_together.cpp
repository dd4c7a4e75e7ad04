#include "libgeom/placement/rest_together.hpp"

#include "libgeom/placement/descent.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace geom {
namespace {

constexpr int sweeps = 400;     // over all impulses, at most
constexpr double creeps = 0.06; // of s, a step: what is slower rests
constexpr double slides = 0.15; // and what is faster goes on with larger steps

// Bodies that move, those that stay, and their touches.
class Together {
public:
  Together(const Features& shape, const std::vector<Pose>& start, const std::vector<const Features*>& others,
           const RestOptions& options)
      : poses(start), stays(start.size(), 0), shape_(shape), start_(start), others_(others),
        options_(options), radius_(radius_of(shape)) {}

  // A step; returns the motions.
  std::vector<Motion> step(const Vec3& down, double s);
  void push_clear();
  std::vector<int> pressed_by();

  std::vector<Pose> poses;
  std::vector<char> stays;

private:
  struct Pair {
    int body = 0, other = -1; // -1: one of the others,
    std::size_t fixed = 0;    // this one
    NearFeatures near;
    std::size_t touches = 0; // of those made last
  };
  void find(double reach);
  // Within reach of a step s; from the top down.
  std::vector<BodyTouch> touches(double s);
  BodyTouch made_of(Touch touch, const Pair& pair) const;
  std::vector<Motion> motions(std::vector<BodyTouch>& touches, const Vec3& pull,
                              const ImpulseOptions& options) {
    std::vector<BodyBound> no_bounds;
    return geom::motions(touches, no_bounds, poses.size(), pull, options);
  }
  void move(const std::vector<Motion>&, bool put_back);

  const Features& shape_;
  const std::vector<Pose>& start_;
  const std::vector<const Features*>& others_;
  const RestOptions& options_;
  double radius_ = 0;
  double room_ = -1; // m, by which bodies may still come nearer before pairs are looked for again
  std::vector<Features> bodies_;
  std::vector<Pair> pairs_;
};

void Together::find(double reach) {
  std::vector<int> order(poses.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return options_.down.dot(poses[a].translation) < options_.down.dot(poses[b].translation);
  });
  pairs_.clear();
  const auto add = [&](Pair pair, const Features& other) {
    pair.near = NearFeatures(bodies_[pair.body], other, reach);
    if (!pair.near.empty())
      pairs_.push_back(std::move(pair));
  };
  for (std::size_t i = 0; i < order.size(); ++i) {
    const int body = order[i];
    for (std::size_t k = i + 1; k < order.size(); ++k) {
      const int other = order[k];
      if ((stays[body] == 0 || stays[other] == 0) &&
          (poses[body].translation - poses[other].translation).norm() < 2 * radius_ + reach)
        add({body, other, 0, {}, 0}, bodies_[other]);
    }
    for (std::size_t k = 0; k < others_.size() && stays[body] == 0; ++k)
      add({body, -1, k, {}, 0}, *others_[k]);
  }
}

BodyTouch Together::made_of(Touch touch, const Pair& pair) const {
  int body = pair.body, other = pair.other;
  if (stays[body] != 0) {
    std::swap(body, other);
    touch.normal = -touch.normal;
  }
  if (other >= 0 && stays[other] != 0)
    other = -1;
  const Vec3& here = poses[body].translation;
  BodyTouch made =
      body_touch(touch, body, other, {here, other < 0 ? here : poses[other].translation}, options_.gyration);
  made.room -= options_.clear;
  return made;
}

std::vector<BodyTouch> Together::touches(double s) {
  const double reach = 2 * s + options_.clear, skin = descent::skin * s;
  bodies_.clear();
  for (const Pose& pose : poses)
    bodies_.push_back(moved(shape_, pose));
  if (room_ < 0) {
    find(reach + skin);
    room_ = skin;
  }
  std::vector<BodyTouch> made;
  std::vector<Touch> found;
  for (Pair& pair : pairs_) {
    found.clear();
    pair.near.touches(bodies_[pair.body], pair.other < 0 ? *others_[pair.fixed] : bodies_[pair.other], reach,
                      found);
    pair.touches = found.size();
    for (const Touch& touch : found)
      made.push_back(made_of(touch, pair));
  }
  return made;
}

void Together::move(const std::vector<Motion>& v, bool put_back) {
  double most = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (stays[i] != 0)
      continue;
    most = std::max(most, geom::move(poses[i], v[i], options_.gyration, radius_));
    if (put_back && (poses[i].translation - start_[i].translation).norm() > options_.way) {
      poses[i] = start_[i];
      stays[i] = 1;
      room_ = -1;
    }
  }
  room_ -= 2 * most;
}

std::vector<Motion> Together::step(const Vec3& down, double s) {
  std::vector<BodyTouch> touches = this->touches(s);
  std::vector<Motion> v = motions(touches, s * down, {options_.friction, s, sweeps});
  move(v, true);
  return v;
}

void Together::push_clear() {
  const double slack = 1e-3 * options_.clear;
  for (int k = 0; k < descent::pushes; ++k) {
    std::vector<BodyTouch> made = touches(options_.clear);
    if (std::all_of(made.begin(), made.end(), [](const BodyTouch& touch) { return touch.room >= 0; }))
      break;
    for (BodyTouch& touch : made)
      touch.room -= slack;
    move(motions(made, Vec3::Zero(), {0, options_.clear, sweeps}), false);
  }
}

std::vector<int> Together::pressed_by() {
  const ImpulseOptions probing = geom::probing(options_, sweeps);
  room_ = -1; // the reach may be a larger one
  std::vector<BodyTouch> made = touches(probing.step);
  for (BodyTouch& touch : made) // what pushes it out of another does not carry it
    touch.room = std::max(0., touch.room);
  motions(made, probing.step * options_.down, probing);
  std::vector<int> pressed(poses.size(), 0);
  std::size_t at = 0;
  for (const Pair& pair : pairs_) {
    double impulse = 0;
    for (std::size_t i = 0; i < pair.touches; ++i)
      impulse += made[at++].normal.impulse;
    if (!(impulse > descent::presses * probing.step))
      continue;
    ++pressed[pair.body];
    if (pair.other >= 0)
      ++pressed[pair.other];
  }
  return pressed;
}

} // namespace

RestTogether come_to_rest_together(const Features& shape, const std::vector<Pose>& start,
                                   const std::vector<const Features*>& others, const RestOptions& options) {
  RestTogether rest;
  Together together(shape, start, others, options);
  Descent descent(options);
  std::vector<Motion> cycle(start.size()); // since gravity was first tilted this way
  for (int k = 0; k < options.steps && !rest.still; ++k) {
    const double s = descent.s;
    const std::vector<Motion> v = together.step(descent.down(k), s);
    double most = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (together.stays[i] != 0)
        continue;
      cycle[i].shift += v[i].shift;
      cycle[i].turn += v[i].turn;
      most = std::max(most, cycle[i].norm());
    }
    if ((k + 1) % descent::tilts != 0)
      continue;
    std::fill(cycle.begin(), cycle.end(), Motion{});
    if (most > descent::tilts * slides * s)
      descent.hurry();
    rest.still = most < descent::tilts * creeps * s && descent.at_last();
  }
  together.push_clear();
  if (rest.still)
    rest.pressed_by = together.pressed_by();
  rest.poses = std::move(together.poses);
  rest.stayed = std::move(together.stays);
  return rest;
}

} // namespace geom
