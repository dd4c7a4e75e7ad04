// Cavities that a mesh closes: water stands outside of them.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// Per triangle of MeshData::boundary, the number of the closed shell inside a body that it belongs to, 0 for none. A shell is
// triangles joined at their edges, each edge between two, around a negative volume as their normals look out of the body.
std::vector<int> of_inner_shells(const Model&);

} // namespace cdem
