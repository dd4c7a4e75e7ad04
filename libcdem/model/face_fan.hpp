// The triangles of a face of a convex block.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// Over the block's own nodes, from 0, seen from outside.
std::vector<geom::Triangle> fan_of(const Model&, int block, int face);

} // namespace cdem
