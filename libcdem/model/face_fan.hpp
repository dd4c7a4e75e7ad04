// The triangles of a face of a convex block.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// Over the block's own nodes, from 0, seen from outside.
std::vector<geom::Triangle> fan_of(const Model&, int block, int face);
std::vector<std::vector<geom::Triangle>> fans_of(const Model&, int block); // of all faces

} // namespace cdem
