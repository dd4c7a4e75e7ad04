#include "libcdem/procedure/support_way.hpp"

#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

constexpr double balance = 0.005; // residual
constexpr double rate = 1.0 / 40; // per step
constexpr double first_pace = 1e-6, last_pace = 1e-4;
constexpr double recent = 0.25; // part of the way
constexpr double least_before = 1e-5, of_residual = 100;
constexpr double most_learning = 0.25; // of the damping
constexpr double patience = 40;        // slowest periods

} // namespace

double SupportWay::least_damping() const {
  return way_ < 1 ? 4 * M_PI / period_ : 0;
}

void SupportWay::choose_pace(std::int64_t step, double residual, double damping) {
  const double old = pace_;
  growth_ = learning_ = 0;
  if (way_ >= 1) {
    pace_ = 0;
    return;
  }
  if (old > 0) {
    pace_ = std::max(first_pace, old * geom::portable::exp(rate * std::max(-1.0, 1 - residual / balance)));
  } else if (residual <= balance) {
    pace_ = first_pace;
    before_ = std::max(least_before, of_residual * residual);
  }
  pace_ = std::min({pace_, rate * (1 - way_) + last_pace, 1 - way_});
  const double late = std::clamp(static_cast<double>(step + 1) / (patience * period_) - 1, 0.0, 1.0);
  const double least = late * late - way_;
  if (least > pace_) {
    pace_ = least;
  } else if (pace_ > 0) {
    growth_ = old > 0 ? pace_ / old : 0;
    learning_ = std::min(pace_ / (recent * (way_ + before_)), most_learning * damping);
  }
  acts_ = acts_ || pace_ > 0;
}

void SupportWay::end_step() {
  acts_ = acts_ && pace_ > 0; // one step more takes the lead off
  way_ = pace_ >= 1 - way_ ? 1 : way_ + pace_;
}

void SupportWay::take_off(const MovingNodes& nodes, std::int64_t first) const {
  for (std::int64_t i = 0; i < nodes.count; ++i) {
    const Node& lead = lead_[first + i];
    Node& velocity = nodes.velocity[i];
    velocity.x -= lead.x;
    velocity.y -= lead.y;
    velocity.z -= lead.z;
  }
}

void SupportWay::put_on(const MovingNodes& nodes, std::int64_t first, const Node& free, const Node* force,
                        NodeSums& sums) {
  const auto add = [&](double is_free, double f, double load, double& lead, double& velocity,
                       double& displacement) {
    if (is_free == 0)
      return;
    const double before = lead;
    lead = growth_ * before + learning_ * velocity;
    velocity += lead;
    displacement += lead;
    const double mean = 0.5 * (before + lead);
    sums.external += load * mean;
    sums.fictitious += f * mean;
  };
  for (std::int64_t i = 0; i < nodes.count; ++i) {
    const Node load = nodes.external ? nodes.external[i] : Node{};
    const Node& f = force[i];
    Node &l = lead_[first + i], &v = nodes.velocity[i], &u = nodes.displacement[i];
    add(free.x, f.x, load.x, l.x, v.x, u.x);
    add(free.y, f.y, load.y, l.y, v.y, u.y);
    add(free.z, f.z, load.z, l.z, v.z, u.z);
  }
}

void SupportWay::add_to(std::vector<double>& loop_state) const {
  loop_state.insert(loop_state.end(), {way_, pace_, before_, growth_, learning_, acts_ ? 1.0 : 0.0});
}

std::size_t SupportWay::take(const std::vector<double>& loop_state, std::size_t from) {
  way_ = loop_state.at(from);
  pace_ = loop_state.at(from + 1);
  before_ = loop_state.at(from + 2);
  growth_ = loop_state.at(from + 3);
  learning_ = loop_state.at(from + 4);
  acts_ = loop_state.at(from + 5) != 0;
  return from + 6;
}

} // namespace cdem
