// Laying, second part: all units come to rest together, and units with too few supports are repositioned.
#include "libgeom/placement/laying.hpp"

#include "libgeom/core/random.hpp"
#include "libgeom/placement/rest_together.hpp"

#include <algorithm>
#include <limits>

namespace geom {
namespace {

// When all units come to rest at once.
constexpr int first_steps = 1000, later_steps = 400;    // at most
constexpr double first_step = 0.01, later_step = 0.003; // over the height

// When units with too few supports are repositioned.
constexpr int most_rounds = 40, most_in_vain = 20; // the latter in a row
constexpr int units_times_rounds = 4000;           // at most: every round takes all to rest again
constexpr std::uint64_t positions_tried = 20;
constexpr int without_position = 5; // rounds in which a unit found none: it is left alone
constexpr int positions_wanted = 4;
constexpr double same_position = 0.01;               // over the height: nearer is the position it had
constexpr double least_turn = 0.1, turn_step = 0.02; // radians
constexpr double lift = 0.3;                         // over the height
constexpr double shift_per_radian = 0.3;             // over the height, for each radian

constexpr std::uint64_t position_id = std::uint64_t{1} << 45; // random numbers of its own

} // namespace

void Laying::rest_together(int held) {
  rest_together(held, first_step * height_, first_steps);
}

void Laying::rest_together(int held, double step, int steps) {
  rested_ = {};
  if (options_.nudges == 0)
    return;
  if (held >= static_cast<int>(laid_.size())) { // each by itself
    rested_.still = true;
    return;
  }
  std::vector<const Features*> others{&ground_features_};
  for (const Features& wall : wall_features_)
    others.push_back(&wall);
  std::vector<Pose> poses;
  for (int i = 0; i < static_cast<int>(laid_.size()); ++i) {
    if (i < held)
      others.push_back(&laid_[i].features);
    else
      poses.push_back(laid_[i].pose);
  }
  RestOptions options = resting(options_.friction);
  options.step = step;
  options.steps = steps;
  options.way = roll * height_;
  options.poll = poll_;
  const RestTogether rest = come_to_rest_together(features_, poses, others, options);
  std::vector<Laid> other(laid_.begin(), laid_.begin() + held); // laid_ as it will be, then as it was
  for (const Pose& pose : rest.poses)
    other.push_back(laid_at(pose));
  std::swap(laid_, other);
  for (int i = held; i < static_cast<int>(laid_.size()); ++i)
    if (!clear(laid_[i].pose, near(laid_[i].pose.translation, 2 * radius_ + gap_, i))) {
      std::swap(laid_, other);
      return;
    }
  rested_.still = rest.still;
  for (std::size_t i = 0; i < rest.stayed.size(); ++i) {
    const int unit = held + static_cast<int>(i);
    if (rest.stayed[i] != 0)
      rested_.put_back.push_back(unit);
    else if (rest.still && rest.pressed_by[i] < least_carriers)
      rested_.leaning.push_back(unit);
  }
}

// The best of some other positions near by in which three bodies support the unit: it is rotated and shifted, more in
// each round, or lifted and in any attitude. False where there is none.
bool Laying::reposition(int unit, int round) {
  const Pose here = laid_[unit].pose;
  const std::vector<Mat3> rotations = attitudes(sites_[unit]);
  const std::uint64_t id =
      position_id + static_cast<std::uint64_t>(unit) + (static_cast<std::uint64_t>(round) << 32);
  Try best{here, std::numeric_limits<double>::infinity()};
  int found = 0;
  for (std::uint64_t k = 0; k < positions_tried && found < positions_wanted; ++k) {
    const auto draw = [&](std::uint64_t i) { return 2 * uniform(options_.seed, id, 6 * k + i) - 1; };
    const double angle = least_turn * (1 + round) + turn_step * static_cast<double>(k);
    const Vec3 turn = angle * Vec3(draw(0), draw(1), draw(2));
    const Vec3 shift = shift_per_radian * height_ * angle * Vec3(draw(3), draw(4), draw(5));
    Pose start{turned(here.rotation, turn), here.translation + shift};
    const bool anew = k % 2 == 1;
    if (anew) {
      const std::uint64_t number = (k + positions_tried * static_cast<std::uint64_t>(round)) / 2;
      start.rotation = turned(rotations[number % rotations.size()], turn);
      start.translation += lift * height_ * frame_.row(2);
    }
    const Near around = on_the_way(start.translation, unit);
    const Try one = rested({start}, sites_[unit], around);
    const double away = (one.pose.translation - here.translation).norm();
    if (!one.good || (!anew && away < same_position * height_) || !clear(one.pose, around))
      continue;
    ++found;
    const double cost = one.cost + away / height_;
    if (cost < best.cost)
      best = {one.pose, cost};
  }
  if (found > 0)
    laid_[unit] = laid_at(best.pose);
  return found > 0;
}

void Laying::reposition_unsupported(int held) {
  const int rounds = std::clamp(units_times_rounds / static_cast<int>(laid_.size()), 4, most_rounds);
  const int rounds_in_vain = std::min(most_in_vain, (rounds + 1) / 2);
  int in_vain = 0; // rounds in a row
  std::vector<int> found_none(laid_.size(), 0);
  for (int round = 0; round < rounds && in_vain < rounds_in_vain && !rested_.leaning.empty(); ++round) {
    const std::vector<Laid> before = laid_;
    const Rested rested = rested_;
    bool any = false;
    for (const int unit : rested.leaning) {
      if (found_none[unit] == without_position)
        continue;
      poll_();
      if (reposition(unit, round))
        any = true;
      else
        ++found_none[unit];
    }
    if (any)
      rest_together(held, later_step * height_, later_steps);
    const bool no_worse = any && rested_.still && rested_.put_back.size() <= rested.put_back.size() &&
                          rested_.leaning.size() <= rested.leaning.size();
    in_vain = no_worse && rested_.leaning.size() < rested.leaning.size() ? 0 : in_vain + 1;
    if (no_worse)
      continue;
    laid_ = before;
    rested_ = rested;
  }
}

} // namespace geom
