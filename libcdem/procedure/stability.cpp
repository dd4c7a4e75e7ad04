#include "libcdem/procedure/stability.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

constexpr double keeps_speed = 0.8;  // of the third quarter, in the last one
constexpr double makes_motion = 1.5; // times the displacement of half the steps ago
constexpr double stored_part = 0.1;  // of the work
constexpr double taken_back = 0.1;   // of the work that the loads have given
constexpr double stays_out = 0.5;    // of the residual of the third quarter, in the last one
constexpr double periods = 4;
constexpr double far = 0.01; // of the model's length
// Fewer looks have no quarters.
constexpr std::size_t least_looks = 4;

} // namespace

const char* name(Verdict verdict) {
  switch (verdict) {
  case Verdict::stable:
    return "stable";
  case Verdict::failing:
    return "failing";
  case Verdict::undecided:
    break;
  }
  return "undecided";
}

void StabilityWatch::add(const StabilityLook& look) {
  if (look.step <= waiting_)
    return;
  looks_.push_back(look);
  suspicious_ = runs_away() ? suspicious_ + 1 : 0;
}

void StabilityWatch::start_anew() {
  looks_.clear();
  suspicious_ = 0;
}

bool StabilityWatch::runs_away() const {
  const std::size_t n = looks_.size();
  if (n < least_looks)
    return false;
  const std::size_t at_c = n - 1, at_a = (n - 1) / 2, at_b = (at_a + at_c) / 2;
  const StabilityLook &a = looks_[at_a], &b = looks_[at_b], &c = looks_[at_c];
  // A stone that slides may rattle from look to look: means count.
  const std::size_t eighth = std::max<std::size_t>(1, (at_c - at_a) / 4), parts = (at_c - at_a) / eighth;
  const auto mean_work = [&](std::size_t part) { // J; part 0 is the last one
    double sum = 0;
    for (std::size_t i = 0; i < eighth; ++i)
      sum += looks_[at_c - part * eighth - i].work;
    return sum / static_cast<double>(eighth);
  };
  double given = 0, taken = 0; // J
  for (std::size_t part = 0; part < parts; ++part) {
    const double work = mean_work(part) - mean_work(part + 1);
    (work > 0 ? given : taken) += std::abs(work);
  }
  if (!(given > 0) || taken > taken_back * given)
    return false;
  const double last_half = mean_work(0) - mean_work(parts / 2),
               first_half = mean_work(parts / 2) - mean_work(parts / 2 * 2);
  if (last_half < keeps_speed * first_half)
    return false;
  // Means over as many looks, or one less.
  const auto mean_residual = [&](std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t i = first + 1; i <= last; ++i)
      sum += looks_[i].residual;
    return sum / static_cast<double>(last - first);
  };
  if ((c.falls || static_cast<double>(c.step - waiting_) < periods * period_) &&
      c.path - a.path < far * length_)
    return false;
  const double last_quarter = static_cast<double>(c.step - b.step),
               third_quarter = static_cast<double>(b.step - a.step);
  return (c.path - b.path) / last_quarter >= keeps_speed * (b.path - a.path) / third_quarter &&
         c.path >= makes_motion * a.path && c.stored - a.stored <= stored_part * (c.work - a.work) &&
         mean_residual(at_b, at_c) >= stays_out * mean_residual(at_a, at_b);
}

void StabilityWatch::add_to(std::vector<double>& loop_state) const {
  loop_state.insert(loop_state.end(), {static_cast<double>(suspicious_), static_cast<double>(waiting_)});
  for (const StabilityLook& look : looks_)
    loop_state.insert(loop_state.end(), {static_cast<double>(look.step), look.path, look.residual, look.work,
                                         look.stored, look.falls ? 1.0 : 0.0});
}

void StabilityWatch::take(const std::vector<double>& loop_state, std::size_t from) {
  suspicious_ = static_cast<int>(loop_state.at(from));
  waiting_ = static_cast<std::int64_t>(loop_state.at(from + 1));
  looks_.clear();
  for (std::size_t i = from + 2; i + 6 <= loop_state.size(); i += 6)
    looks_.push_back({static_cast<std::int64_t>(loop_state[i]), loop_state[i + 1], loop_state[i + 2],
                      loop_state[i + 3], loop_state[i + 4], loop_state[i + 5] != 0});
}

double slowest_period(const Model& model, const std::vector<double>& mass) {
  double sum = 0, volume = 0, compliance = 0; // kg, m3, m3/Pa
  for (const double m : mass)
    sum += m;
  for (const Block& block : model.blocks) {
    volume += block.mass.volume;
    compliance += block.mass.volume / model.bodies[block.body].material.youngs_modulus;
  }
  for (const BondPoint& point : model.points)
    compliance += point.area / (3 * model.interfaces[point.interface].kn);
  const double speed2 = volume * volume / (compliance * sum); // E' V / sum m
  return 4 * model.length / std::sqrt(speed2);
}

Fastest fastest(const std::vector<Node>& from, const std::vector<Node>& to, const std::vector<char>& of) {
  Fastest found;
  double most2 = 0;
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (!of.empty() && !of[i])
      continue;
    const double x = to[i].x - from[i].x, y = to[i].y - from[i].y, z = to[i].z - from[i].z;
    const double moved2 = x * x + y * y + z * z;
    if (moved2 > most2) {
      most2 = moved2;
      found.node = static_cast<int>(i);
    }
  }
  found.displacement = std::sqrt(most2);
  return found;
}

} // namespace cdem
