// Measures of a solid under a flow: compliance, period, and position of the break.
#pragma once

#include "libcdem/results/log.hpp"
#include "libcdem/state/state.hpp"

#include <utility>
#include <vector>

namespace cdem {

using NodeForces = std::vector<std::pair<int, geom::Vec3>>; // node, N

// Displacement since `start` (m, n_nodes) that the pattern of forces does its work on, over the sum of its weights, m.
double displacement_along(const NodeForces& pattern, const State&, const std::vector<Node>& start);

// s, of Rayleigh's quotient of the static shape u under the pattern times `pressure`: 2 pi sqrt(u . M u / u . F).
double first_period(const Model&, const NodeForces& pattern, double pressure, const State&,
                    const std::vector<Node>& start);

struct BrokenArea {
  double area = 0;                          // m2
  geom::Vec3 centroid = geom::Vec3::Zero(); // m, undeformed
};
// Area of the bonds that broke from the row `first` on, or only in the step of that row.
BrokenArea broken_area(const RunLog&, std::size_t first, bool of_one_step);

} // namespace cdem
