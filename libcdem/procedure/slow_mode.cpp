#include "libcdem/procedure/slow_mode.hpp"

#include <algorithm>

namespace cdem {

void SlowMode::start(const State& state, const std::vector<Node>& force) {
  from_ = state.displacement;
  for (std::size_t i = 0; i < from_.size(); ++i) {
    from_[i].x -= state.velocity[i].x;
    from_[i].y -= state.velocity[i].y;
    from_[i].z -= state.velocity[i].z;
  }
  force_ = force;
}

void SlowMode::look(const State& state, const std::vector<Node>& force, const std::vector<double>& mass) {
  const std::vector<Node> before = std::move(from_), force_before = std::move(force_);
  start(state, force);
  frequency2_.reset();
  if (before.size() != from_.size())
    return;
  double stiffness = 0, inertia = 0;
  for (std::size_t i = 0; i < from_.size(); ++i) {
    const double x = from_[i].x - before[i].x, y = from_[i].y - before[i].y, z = from_[i].z - before[i].z;
    stiffness -= x * (force[i].x - force_before[i].x) + y * (force[i].y - force_before[i].y) +
                 z * (force[i].z - force_before[i].z);
    inertia += mass[i] * (x * x + y * y + z * z);
  }
  if (inertia > 0)
    frequency2_ = std::max(0.0, stiffness / inertia);
}

void SlowMode::take(double frequency2) {
  frequency2_.reset();
  if (frequency2 >= 0)
    frequency2_ = frequency2;
}

} // namespace cdem
