// Static solution of the star mesh with nodes of neighbouring blocks tied together, by a sparse direct solver
// with its own element matrices: what the springs' solution must go to as their thickness goes to 0.
#pragma once

#include "libcdem/model/model.hpp"

#include <functional>

namespace testing {

struct TiedProblem {
  // Which components of the node at a place are held at 0.
  std::function<std::array<bool, 3>(const geom::Vec3&)> held;
  // Traction on an outer face of this centre and outward normal, Pa.
  std::function<geom::Vec3(const geom::Vec3& centre, const geom::Vec3& normal)> traction;
};

// Displacement of every node of the model, m (n_nodes). Faces of neighbours must match.
std::vector<geom::Vec3> tied_solution(const cdem::Model&, const TiedProblem&);

} // namespace testing
