// Cavities that a mesh closes: water stands outside of them.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// Per triangle of MeshData::boundary, 1 where it belongs to a closed shell inside a body: triangles joined at their edges, each
// edge between two, around a negative volume as their normals look out of the body.
std::vector<char> of_inner_shells(const Model&);

} // namespace cdem
