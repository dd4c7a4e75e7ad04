// A model whose cohesive bodies have more of their nodes freed.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// All but the mesh parts stays. Tets, outer triangles and blocks keep their numbers; nodes and freed faces get new ones.
// freed: per node of `old`, 1 for those to be freed beside those that are.
Model with_freed_nodes(const Model& old, const std::vector<char>& freed);

} // namespace cdem
