#include "libcdem/procedure/stability.hpp"

#include <cmath>

namespace cdem {
namespace {

constexpr double keeps_speed = 0.8;  // of the third quarter, in the last one
constexpr double makes_motion = 1.5; // times the displacement of half the steps ago
constexpr double stored_part = 0.1;  // of the work
constexpr double taken_back = 0.1;   // of the work that the loads have given from look to look
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

bool StabilityWatch::runs_away() const {
  const std::size_t n = looks_.size();
  if (n < least_looks)
    return false;
  const std::size_t at_c = n - 1, at_a = (n - 1) / 2, at_b = (at_a + at_c) / 2;
  const StabilityLook &a = looks_[at_a], &b = looks_[at_b], &c = looks_[at_c];
  double given = 0, taken = 0; // J, work from look to look
  for (std::size_t i = at_a + 1; i <= at_c; ++i) {
    const double work = looks_[i].work - looks_[i - 1].work;
    (work > 0 ? given : taken) += std::abs(work);
  }
  if (!(given > 0) || taken > taken_back * given)
    return false;
  // Means over as many looks, or one less.
  const auto mean_residual = [&](std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t i = first + 1; i <= last; ++i)
      sum += looks_[i].residual;
    return sum / static_cast<double>(last - first);
  };
  if (static_cast<double>(c.step - waiting_) < periods * period_ && c.path - a.path < far * length_)
    return false;
  const double last_quarter = static_cast<double>(c.step - b.step),
               third_quarter = static_cast<double>(b.step - a.step);
  return (c.path - b.path) / last_quarter >= keeps_speed * (b.path - a.path) / third_quarter &&
         c.path >= makes_motion * a.path && c.stored - a.stored <= stored_part * (c.work - a.work) &&
         mean_residual(at_b, at_c) >= stays_out * mean_residual(at_a, at_b);
}

void StabilityWatch::add_to(std::vector<double>& loop_state) const {
  loop_state.push_back(suspicious_);
  for (const StabilityLook& look : looks_)
    loop_state.insert(loop_state.end(),
                      {static_cast<double>(look.step), look.path, look.residual, look.work, look.stored});
}

void StabilityWatch::take(const std::vector<double>& loop_state, std::size_t from) {
  suspicious_ = static_cast<int>(loop_state.at(from));
  looks_.clear();
  for (std::size_t i = from + 1; i + 5 <= loop_state.size(); i += 5)
    looks_.push_back({static_cast<std::int64_t>(loop_state[i]), loop_state[i + 1], loop_state[i + 2],
                      loop_state[i + 3], loop_state[i + 4]});
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

Fastest fastest(const std::vector<Node>& from, const std::vector<Node>& to) {
  Fastest found;
  double most2 = 0;
  for (std::size_t i = 0; i < to.size(); ++i) {
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
