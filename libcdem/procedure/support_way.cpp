#include "libcdem/procedure/support_way.hpp"

#include "libcdem/step/stage.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {
namespace {

constexpr double balance = 0.005; // residual
constexpr double contact_jump = 0.05, least_of_loads = 0.01;
constexpr double rate = 1.0 / 40; // per step
constexpr double least_pace = 1e-9, first_pace = 1e-6, arrival_pace = 1e-4;
constexpr double slowed_down = 0.125;
constexpr double recent = 0.25; // part of the way
constexpr double least_before = 1e-5, of_residual = 100, steps_before = 100;
constexpr double most_learning = 0.25; // of the damping
constexpr double patience = 40;        // slowest periods

// counted: 1 for the components that count, 0 for the others.
double squared_norm(const Node& v, const Node& counted) {
  const double x = counted.x * v.x, y = counted.y * v.y, z = counted.z * v.z;
  return x * x + y * y + z * z;
}

} // namespace

double SupportWay::least_damping() const {
  return way_ < 1 ? 4 * M_PI / period_ : 0;
}

void SupportWay::choose_pace(double residual, double damping, const NodeSums& sums) {
  const double old = pace_;
  growth_ = learning_ = 0;
  drawn_ = false;
  last_pace_ = pace_;
  if (way_ >= 1) {
    pace_ = 0;
    return;
  }
  ++steps_;
  const double loads2 = residual_reference2(sums);
  double reference2 = loads2;
  if (old > 0) {
    reference2 = std::clamp(sums.led_reaction2, goal_ * goal_ * loads2, loads2);
    residual = reference2 > 0 ? std::sqrt(sums.led_residual2 / reference2) : residual;
  }
  if (old >= 0)
    reference2_ = std::max(reference2, least_of_loads * least_of_loads * loads2);
  if (old < 0) {
    pace_ = std::max(least_pace, -slowed_down * old);
    learned_from_ = way_ - steps_before * pace_;
  } else if (old > 0) {
    pace_ = residual > balance ? std::max(std::min(old, first_pace), old * balance / residual)
                               : old * geom::portable::exp(rate * (1 - residual / balance));
  } else if (residual <= balance) {
    pace_ = first_pace;
    learned_from_ = -std::max(least_before, of_residual * residual);
  }
  pace_ = std::min({pace_, rate * (1 - way_) + arrival_pace, 1 - way_});
  const double least = late() * late() - way_;
  if (least > pace_) {
    pace_ = std::min(least, 1 - way_);
    drawn_ = true;
  } else if (pace_ > 0) {
    growth_ = old != 0 ? pace_ / old : 0;
    learning_ = std::min(pace_ / (recent * (way_ - learned_from_)), most_learning * damping);
  }
  acts_ = acts_ || pace_ > 0;
}

double SupportWay::late() const {
  return std::clamp(steps_ / (patience * period_) - 1, 0.0, 1.0);
}

bool SupportWay::see_contacts(double change2) {
  if (last_pace_ > least_pace && pace_ > 0 && late() == 0 &&
      change2 > contact_jump * contact_jump * reference2_)
    pace_ = -last_pace_;
  return takes_back();
}

void SupportWay::end_step() {
  acts_ = acts_ && pace_ != 0; // one step more takes the lead off
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

void SupportWay::put_on(const MovingNodes& nodes, std::int64_t first, const Node& free,
                        const Node& prescribed, const Node* force, NodeSums& sums) {
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
  const Node held{1 - free.x, 1 - free.y, 1 - free.z, 0};
  const double fastest2 = length_ * pace_ * length_ * pace_;
  for (std::int64_t i = 0; i < nodes.count; ++i) {
    const Node load = nodes.external ? nodes.external[i] : Node{};
    const Node& f = force[i];
    Node &l = lead_[first + i], &v = nodes.velocity[i], &u = nodes.displacement[i];
    add(free.x, f.x, load.x, l.x, v.x, u.x);
    add(free.y, f.y, load.y, l.y, v.y, u.y);
    add(free.z, f.z, load.z, l.z, v.z, u.z);
    if (fastest2 > 0) {
      sums.led_residual2 += squared_norm(f, free) * std::min(1.0, squared_norm(v, {1, 1, 1, 0}) / fastest2);
      sums.led_reaction2 += squared_norm(f, held) * (squared_norm(prescribed, held) / fastest2);
    }
  }
}

void SupportWay::step_back(const MovingNodes& nodes, std::int64_t first, const Node& free,
                           const Node& prescribed, Node* previous_force, NodeSums& sums) {
  const auto back = [&](double is_free, double given, double mass, double f, double load, double& lead,
                        double& velocity, double& displacement) {
    const double before = velocity, w = before - lead;
    velocity = is_free != 0 ? -lead : given;
    displacement += velocity;
    const double mean = 0.5 * (before + velocity);
    if (is_free == 0) {
      sums.reaction2 += f * f;
      sums.external += (load - f) * mean;
      return;
    }
    lead = velocity;
    sums.residual2 += f * f;
    sums.applied2 += load * load;
    sums.external += load * mean;
    sums.fictitious += f * mean + 0.5 * mass * w * w;
  };
  MovingNodes node = nodes;
  for (std::int64_t i = 0; i < nodes.count; ++i) {
    const auto at = [&](const Node* all) { return all ? all + i : nullptr; };
    node.force = at(nodes.force);
    node.internal = at(nodes.internal);
    node.external = at(nodes.external);
    node.contact = at(nodes.contact);
    const auto [f, load] = held_node_forces(node);
    Node &l = lead_[first + i], &v = nodes.velocity[i], &u = nodes.displacement[i];
    back(free.x, prescribed.x, nodes.mass[i], f.x, load.x, l.x, v.x, u.x);
    back(free.y, prescribed.y, nodes.mass[i], f.y, load.y, l.y, v.y, u.y);
    back(free.z, prescribed.z, nodes.mass[i], f.z, load.z, l.z, v.z, u.z);
    previous_force[i] = f;
  }
}

void SupportWay::add_to(std::vector<double>& loop_state) const {
  loop_state.insert(loop_state.end(), {way_, pace_, learned_from_, last_pace_, reference2_, growth_,
                                       learning_, length_, steps_, drawn_ ? 1.0 : 0.0, acts_ ? 1.0 : 0.0});
}

std::size_t SupportWay::take(const std::vector<double>& loop_state, std::size_t from) {
  way_ = loop_state.at(from);
  pace_ = loop_state.at(from + 1);
  learned_from_ = loop_state.at(from + 2);
  last_pace_ = loop_state.at(from + 3);
  reference2_ = loop_state.at(from + 4);
  growth_ = loop_state.at(from + 5);
  learning_ = loop_state.at(from + 6);
  length_ = loop_state.at(from + 7);
  steps_ = loop_state.at(from + 8);
  drawn_ = loop_state.at(from + 9) != 0;
  acts_ = loop_state.at(from + 10) != 0;
  return from + 11;
}

} // namespace cdem
