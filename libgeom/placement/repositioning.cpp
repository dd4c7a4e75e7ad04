// Laying, second part: all units come to rest together, and units with too few supports are repositioned.
#include "libgeom/placement/laying.hpp"

#include "libgeom/core/random.hpp"
#include "libgeom/placement/rest_together.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <utility>

namespace geom {
namespace {

// When all units come to rest at once.
constexpr int first_steps = 1000, later_steps = 400;    // at most
constexpr double first_step = 0.01, later_step = 0.003; // over the height

// When units with too few supports are repositioned.
constexpr int most_passes = 4, rounds = 6; // all rest together after each pass, after so many rounds
constexpr int most_in_vain = 5;            // rounds that did not help: the unit is left as it is
constexpr double about = 1.6; // over the height: units nearer than this rest with the repositioned one
constexpr std::uint64_t positions_tried = 20;
constexpr int positions_wanted = 4;
constexpr double same_position = 0.01;               // over the height: nearer is the position it had
constexpr double least_turn = 0.1, turn_step = 0.02; // radians
constexpr double lift = 0.3;                         // over the height
constexpr double shift_per_radian = 0.3;             // over the height, for each radian

// Every second position is a lifted one in any attitude.
bool lifted(std::uint64_t position) {
  return position % 2 == 1;
}

constexpr std::uint64_t position_id = std::uint64_t{1} << 45; // random numbers of its own

} // namespace

void Laying::rest_together(int held) {
  rested_ = {};
  if (options_.nudges > 0)
    rest_together(above(held), first_step * height_, first_steps);
}

std::vector<char> Laying::above(int held) const {
  std::vector<char> moves(laid_.size(), 1);
  std::fill(moves.begin(), moves.begin() + std::min(held, static_cast<int>(laid_.size())), 0);
  return moves;
}

std::vector<char> Laying::around(int unit, int held) const {
  std::vector<char> moves(laid_.size(), 0);
  for (int i = held; i < static_cast<int>(laid_.size()); ++i)
    moves[i] = (laid_[i].pose.translation - laid_[unit].pose.translation).norm() < about * height_ ? 1 : 0;
  return moves;
}

// Units that move come to rest together among all others. What was known of the others stays.
void Laying::rest_together(const std::vector<char>& moves, double step, int steps) {
  std::vector<const Features*> others{&ground_features_};
  for (const Features& wall : wall_features_)
    others.push_back(&wall);
  std::vector<Pose> poses;
  std::vector<int> units;
  for (int i = 0; i < static_cast<int>(laid_.size()); ++i) {
    if (moves[i] == 0) {
      others.push_back(&laid_[i].features);
      continue;
    }
    units.push_back(i);
    poses.push_back(laid_[i].pose);
  }
  Rested rested;
  const auto keep = [&](const std::vector<int>& before, std::vector<int>& now) {
    std::copy_if(before.begin(), before.end(), std::back_inserter(now), [&](int i) { return moves[i] == 0; });
  };
  keep(rested_.leaning, rested.leaning);
  keep(rested_.put_back, rested.put_back);
  rested.still = units.empty(); // each by itself
  if (units.empty()) {
    rested_ = rested;
    return;
  }
  RestOptions options = resting(options_.friction);
  options.step = step;
  options.steps = steps;
  options.way = roll * height_;
  options.poll = poll_;
  const RestTogether rest = come_to_rest_together(features_, poses, others, options);
  std::vector<Laid> before;
  for (std::size_t k = 0; k < units.size(); ++k) {
    Laid& unit = laid_[units[k]];
    before.push_back(std::exchange(unit, laid_at(rest.poses[k], unit.cost)));
  }
  const bool all_clear = std::all_of(units.begin(), units.end(), [&](int i) {
    return clear(laid_[i].pose, near(laid_[i].pose.translation, 2 * radius_ + gap_, i));
  });
  if (!all_clear) {
    for (std::size_t k = 0; k < units.size(); ++k)
      laid_[units[k]] = std::move(before[k]);
    rested_ = {};
    return;
  }
  rested.still = rest.still;
  for (std::size_t k = 0; k < units.size(); ++k) {
    if (rest.stayed[k] != 0)
      rested.put_back.push_back(units[k]);
    else if (rest.still && rest.pressed_by[k] < least_carriers)
      rested.leaning.push_back(units[k]);
  }
  std::sort(rested.leaning.begin(), rested.leaning.end());
  std::sort(rested.put_back.begin(), rested.put_back.end());
  rested_ = rested;
}

bool Laying::no_worse_than(const Rested& before) const {
  return rested_.still && rested_.put_back.size() <= before.put_back.size() &&
         rested_.leaning.size() <= before.leaning.size();
}

// The best of some other positions near by in which three bodies support the unit: it is rotated and shifted, more in
// each round, or lifted and in any attitude. False where there is none.
bool Laying::reposition(int unit, int round) {
  const Pose here = laid_[unit].pose;
  const std::vector<Mat3> rotations = attitudes(sites_[unit]);
  const std::uint64_t id =
      position_id + static_cast<std::uint64_t>(unit) + (static_cast<std::uint64_t>(round) << 32);
  const auto start_of = [&](std::uint64_t k) {
    const auto draw = [&](std::uint64_t i) { return 2 * uniform(options_.seed, id, 6 * k + i) - 1; };
    const double angle = least_turn * (1 + round) + turn_step * static_cast<double>(k);
    const Vec3 turn = angle * Vec3(draw(0), draw(1), draw(2));
    const Vec3 shift = shift_per_radian * height_ * angle * Vec3(draw(3), draw(4), draw(5));
    Pose start{turned(here.rotation, turn), here.translation + shift};
    if (lifted(k)) {
      const std::uint64_t number = (k + positions_tried * static_cast<std::uint64_t>(round)) / 2;
      start.rotation = turned(rotations[number % rotations.size()], turn);
      start.translation += lift * height_ * frame_.row(2);
    }
    return start;
  };
  Try best{here, std::numeric_limits<double>::infinity()};
  int found = 0;
  std::array<Try, positions_wanted> tries;
  for (std::uint64_t first = 0; first < positions_tried && found < positions_wanted; first += tries.size()) {
    poll_();
#pragma omp parallel for schedule(dynamic, 1)
    for (std::size_t i = 0; i < tries.size(); ++i) {
      const Pose start = start_of(first + i);
      const Near around = on_the_way(start.translation, unit);
      tries[i] = rested({start}, sites_[unit], around);
      const double away = (tries[i].pose.translation - here.translation).norm();
      tries[i].good = tries[i].good && (lifted(first + i) || away >= same_position * height_) &&
                      clear(tries[i].pose, around);
      tries[i].cost += away / height_;
    }
    for (const Try& one : tries) {
      found += one.good ? 1 : 0;
      if (one.good && one.cost < best.cost)
        best = one;
    }
  }
  if (found > 0)
    laid_[unit] = laid_at(best.pose, best.cost);
  return found > 0;
}

// Each with the units about it, while all others stay where they are.
void Laying::reposition_one_by_one(int held, int first_round, std::vector<int>& in_vain,
                                   const std::function<void(int)>& left) {
  for (int round = first_round; round < first_round + rounds && !rested_.leaning.empty(); ++round) {
    const std::vector<int> leaning = rested_.leaning;
    for (const int unit : leaning) {
      if (in_vain[unit] == most_in_vain ||
          std::count(rested_.leaning.begin(), rested_.leaning.end(), unit) == 0)
        continue;
      left(static_cast<int>(rested_.leaning.size()));
      const std::vector<Laid> before = laid_;
      const Rested rested = rested_;
      if (reposition(unit, round)) {
        rest_together(around(unit, held), later_step * height_, later_steps);
        if (no_worse_than(rested)) {
          in_vain[unit] += rested_.leaning.size() < rested.leaning.size() ? 0 : 1;
          continue;
        }
      }
      ++in_vain[unit];
      laid_ = before;
      rested_ = rested;
    }
  }
}

void Laying::reposition_unsupported(int held, const std::function<void(int)>& left) {
  bool better = true;
  std::vector<int> in_vain(laid_.size(), 0); // rounds
  for (int pass = 0; pass < most_passes && better && !rested_.leaning.empty(); ++pass) {
    const std::vector<Laid> before = laid_;
    const Rested rested = rested_;
    reposition_one_by_one(held, pass * rounds, in_vain, left);
    rest_together(above(held), later_step * height_, later_steps);
    better = no_worse_than(rested) && rested_.leaning.size() < rested.leaning.size();
    if (no_worse_than(rested))
      continue;
    laid_ = before;
    rested_ = rested;
  }
}

} // namespace geom
