// The second moments of a block's solid.
#pragma once

#include "libcdem/model/model.hpp"

#include <functional>

namespace cdem {

// integral r r^T dm, kg m2, as its tetrahedra fill it: the sum of m / 20 (sum r r^T + (sum r)(sum r)^T), m the mass of an
// undeformed tetrahedron. arm: r of a node, m.
geom::Mat3 second_moments(const Model&, int block, const std::function<geom::Vec3(int)>& arm);

} // namespace cdem
