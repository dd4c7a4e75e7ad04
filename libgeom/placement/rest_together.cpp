#include "libgeom/placement/rest_together.hpp"

#include "libgeom/placement/descent.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>

namespace geom {
namespace {

// Over all impulses, at most: on the way, where the next step goes on from them, and with the last s.
constexpr int sweeps_on_the_way = 150, pile_sweeps = 400;
constexpr double creeps = 0.06; // of s, a step: what is slower rests
constexpr double slides = 0.15; // and what is faster goes on with larger steps
// Fraction of the displacement that a body may have. If a body has moved further than allowed, the lowest body beyond
// this fraction is held, and all begin again. After so many beginnings a body that goes too far is put back at once.
constexpr double goes_on = 0.8;
constexpr int begins_again = 6;
constexpr int bodies_times_beginnings = 600;
constexpr double too_far = 2; // times what is needed: lists that reach further are made anew

// Bodies that move, bodies that stay, and their contact points.
class Together {
public:
  Together(const Features& shape, const std::vector<Pose>& start, const std::vector<const Features*>& others,
           const RestOptions& options, const std::vector<char>& stays)
      : poses(start), shape_(shape), start_(start), others_(others), options_(options), stays_(stays),
        radius_(radius_of(shape)) {}

  // A step; returns the motions.
  std::vector<Motion> step(const Vec3& down, double s, int tilt);
  void push_clear();
  std::vector<int> pressed_by();
  const std::vector<char>& stays() const { return stays_; }
  bool stays(std::size_t body) const { return stays_[body] != 0; }
  // From now on, where it began.
  void put_back(std::size_t body) {
    poses[body] = start_[body];
    stays_[body] = 1;
    pushed_ = {};
    listed_ = -1;
  }
  // Displacement over the displacement that a body may have.
  double gone(std::size_t body) const {
    return (poses[body].translation - start_[body].translation).norm() / options_.way;
  }

  std::vector<Pose> poses;

private:
  struct Pair {
    int body = 0, other = -1; // -1: one of the others,
    std::size_t fixed = 0;    // this one
    NearFeatures near;
    std::size_t touches = 0; // of those made last
    std::array<int, 3> name() const { return {body, other, static_cast<int>(fixed)}; }
  };
  struct Pushed {
    std::uint64_t features = 0;
    double normal = 0;
    Vec3 along = Vec3::Zero();
  };
  struct Impulses {
    std::map<std::array<int, 3>, std::vector<Pushed>> of_pairs; // by name
    double step = 0;                                            // m, s of theirs
  };
  void find(double reach);
  // Within reach of a step s; from the top down.
  std::vector<BodyTouch> touches(double s);
  BodyTouch made_of(Touch touch, const Pair& pair) const;
  void begin(std::vector<BodyTouch>&, double s, int tilt) const;
  Impulses remembered(const std::vector<BodyTouch>&, double s) const;
  std::vector<Motion> motions(std::vector<BodyTouch>& touches, const Vec3& pull,
                              const ImpulseOptions& options) {
    std::vector<BodyBound> no_bounds;
    return geom::motions(touches, no_bounds, poses.size(), pull, options);
  }
  void move(const std::vector<Motion>&);

  const Features& shape_;
  const std::vector<Pose>& start_;
  const std::vector<const Features*>& others_;
  const RestOptions& options_;
  std::vector<char> stays_;
  double radius_ = 0;
  double listed_ = -1; // m: what is nearer than this is in the pairs
  std::vector<Features> bodies_;
  std::vector<Pair> pairs_;
  std::array<Impulses, descent::tilts> pushed_; // in the last step with gravity tilted each way
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
      if (!(stays(body) && stays(other)) &&
          (poses[body].translation - poses[other].translation).norm() < 2 * radius_ + reach)
        add({body, other, 0, {}, 0}, bodies_[other]);
    }
    for (std::size_t k = 0; k < others_.size() && !stays(body); ++k)
      add({body, -1, k, {}, 0}, *others_[k]);
  }
}

BodyTouch Together::made_of(Touch touch, const Pair& pair) const {
  int body = pair.body, other = pair.other;
  if (stays(body)) {
    std::swap(body, other);
    touch.normal = -touch.normal;
  }
  if (other >= 0 && stays(other))
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
  if (reach > listed_ || listed_ > too_far * (reach + skin)) {
    find(reach + skin);
    listed_ = reach + skin;
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

// Impulses are much as they were when gravity was last tilted this way, or in the last step before it first is.
void Together::begin(std::vector<BodyTouch>& touches, double s, int tilt) const {
  constexpr int tilts = descent::tilts;
  const Impulses& last =
      pushed_[pushed_[tilt].of_pairs.empty() ? (tilt + tilts - 1) % tilts : static_cast<std::size_t>(tilt)];
  if (last.of_pairs.empty())
    return;
  const double part = s / last.step;
  auto touch = touches.begin();
  for (const Pair& pair : pairs_) {
    const auto end = touch + static_cast<std::ptrdiff_t>(pair.touches);
    const auto known = last.of_pairs.find(pair.name());
    for (; touch != end; ++touch) {
      if (known == last.of_pairs.end())
        continue;
      for (const Pushed& pushed : known->second) {
        if (pushed.features != touch->features)
          continue;
        touch->normal.impulse = part * pushed.normal;
        touch->first.impulse = part * pushed.along.dot(touch->first.direction);
        touch->second.impulse = part * pushed.along.dot(touch->second.direction);
      }
    }
  }
}

Together::Impulses Together::remembered(const std::vector<BodyTouch>& touches, double s) const {
  Impulses impulses;
  impulses.step = s;
  auto touch = touches.begin();
  for (const Pair& pair : pairs_)
    for (std::size_t i = 0; i < pair.touches; ++i, ++touch)
      if (touch->normal.impulse > 0)
        impulses.of_pairs[pair.name()].push_back({touch->features, touch->normal.impulse,
                                                  touch->first.impulse * touch->first.direction +
                                                      touch->second.impulse * touch->second.direction});
  return impulses;
}

void Together::move(const std::vector<Motion>& v) {
  double most = 0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (!stays(i))
      most = std::max(most, geom::move(poses[i], v[i], options_.gyration, radius_));
  listed_ -= 2 * most;
}

std::vector<Motion> Together::step(const Vec3& down, double s, int tilt) {
  std::vector<BodyTouch> touches = this->touches(s);
  begin(touches, s, tilt);
  const int at_most = s > options_.last_step ? sweeps_on_the_way : pile_sweeps;
  std::vector<Motion> v = motions(touches, s * down, {options_.friction, s, at_most});
  pushed_[tilt] = remembered(touches, s);
  move(v);
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
    move(motions(made, Vec3::Zero(), {0, options_.clear, pile_sweeps}));
  }
}

std::vector<int> Together::pressed_by() {
  const ImpulseOptions probing = geom::probing(options_, pile_sweeps);
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

// Takes steps until all are at rest, which it returns, or one has gone too far, if that is not to be put back.
bool descend(Together& together, const RestOptions& options, bool puts_back) {
  const std::size_t count = together.poses.size();
  Descent descent(options);
  std::vector<Motion> cycle(count); // since gravity was first tilted this way
  for (int k = 0; k < options.steps; ++k) {
    const double s = descent.s;
    const std::vector<Motion> v = together.step(descent.down(k), s, k % descent::tilts);
    double most = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (together.stays(i))
        continue;
      cycle[i].shift += v[i].shift;
      cycle[i].turn += v[i].turn;
      most = std::max(most, cycle[i].norm());
      if (together.gone(i) > 1) {
        if (!puts_back)
          return false;
        together.put_back(i);
        cycle[i] = {};
      }
    }
    if ((k + 1) % descent::tilts != 0)
      continue;
    if (options.poll)
      options.poll();
    std::fill(cycle.begin(), cycle.end(), Motion{});
    if (most > descent::tilts * slides * s)
      descent.hurry();
    if (most < descent::tilts * creeps * s && descent.at_last())
      return true;
  }
  return false;
}

} // namespace

RestTogether come_to_rest_together(const Features& shape, const std::vector<Pose>& start,
                                   const std::vector<const Features*>& others, const RestOptions& options) {
  RestTogether rest;
  rest.stayed.assign(start.size(), 0);
  const int times =
      std::clamp(bodies_times_beginnings / std::max(1, static_cast<int>(start.size())), 0, begins_again);
  for (int k = 0;; ++k) {
    Together together(shape, start, others, options, rest.stayed);
    rest.still = descend(together, options, k == times);
    double furthest = 0;
    std::size_t lowest = start.size(); // of those that went on
    const auto depth = [&](std::size_t i) { return options.down.dot(start[i].translation); };
    for (std::size_t i = 0; i < start.size(); ++i) {
      furthest = std::max(furthest, together.gone(i));
      if (together.gone(i) > goes_on && (lowest == start.size() || depth(i) > depth(lowest)))
        lowest = i;
    }
    if (furthest <= 1) {
      together.push_clear();
      if (rest.still)
        rest.pressed_by = together.pressed_by();
      rest.stayed = together.stays();
      rest.poses = std::move(together.poses);
      return rest;
    }
    rest.stayed[lowest] = 1;
  }
}

} // namespace geom
