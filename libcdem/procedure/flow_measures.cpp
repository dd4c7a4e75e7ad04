#include "libcdem/procedure/flow_measures.hpp"

#include "libcdem/state/places.hpp"

#include <cmath>

namespace cdem {

double displacement_along(const NodeForces& pattern, const State& state, const std::vector<Node>& start) {
  double work = 0, weight = 0;
  for (const auto& [node, force] : pattern) {
    work += force.dot(vec(state.displacement[node]) - vec(start[node]));
    weight += force.norm();
  }
  return work / weight;
}

double first_period(const Model& model, const NodeForces& pattern, double pressure, const State& state,
                    const std::vector<Node>& start) {
  double work = 0, inertia = 0;
  for (const auto& [node, force] : pattern)
    work += pressure * force.dot(vec(state.displacement[node]) - vec(start[node]));
  for (std::size_t i = 0; i < start.size(); ++i)
    inertia += model.node_mass[i] * (vec(state.displacement[i]) - vec(start[i])).squaredNorm();
  constexpr double two_pi = 6.283185307179586;
  return two_pi * std::sqrt(inertia / work);
}

BrokenArea broken_area(const RunLog& log, std::size_t first, bool of_one_step) {
  BrokenArea sum;
  for (std::size_t i = first; i < log.breaks.size(); ++i) {
    if (of_one_step && log.breaks[i].step != log.breaks[first].step)
      break;
    sum.area += log.breaks[i].area;
    sum.centroid += log.breaks[i].area * log.breaks[i].place;
  }
  if (sum.area > 0)
    sum.centroid /= sum.area;
  return sum;
}

} // namespace cdem
