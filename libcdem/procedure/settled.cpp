#include "libcdem/procedure/settled.hpp"

#include <algorithm>
#include <numeric>

namespace cdem {
namespace {

constexpr std::size_t least_steps = 10, most_steps = 200;

} // namespace

void Settled::add(double residual) {
  if (residuals_.size() == 2 * most_steps) // moved up once in a while, not in every step
    residuals_.erase(residuals_.begin(), residuals_.end() - most_steps);
  residuals_.push_back(residual);
}

bool Settled::reached(double frequency) const {
  if (residuals_.empty() || !(residuals_.back() <= goal_))
    return false;
  const double wanted = frequency > 0 ? 1 / frequency : 0;
  const std::size_t steps =
      wanted >= most_steps ? most_steps : std::max(least_steps, static_cast<std::size_t>(wanted));
  if (residuals_.size() < steps)
    return false;
  const double sum =
      std::accumulate(residuals_.end() - static_cast<std::ptrdiff_t>(steps), residuals_.end(), 0.0);
  return sum <= goal_ * static_cast<double>(steps);
}

void Settled::add_to(std::vector<double>& loop_state) const {
  loop_state.push_back(static_cast<double>(residuals_.size()));
  loop_state.insert(loop_state.end(), residuals_.begin(), residuals_.end());
}

std::size_t Settled::take(const std::vector<double>& loop_state, std::size_t from) {
  const double told = loop_state.at(from++);
  const auto rest = static_cast<double>(loop_state.size() - from);
  const auto count = static_cast<std::ptrdiff_t>(std::clamp(told, 0.0, rest));
  const auto first = loop_state.begin() + static_cast<std::ptrdiff_t>(from);
  residuals_.assign(first, first + count);
  return from + static_cast<std::size_t>(count);
}

} // namespace cdem
