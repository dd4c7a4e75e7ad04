// A model whose cohesive bodies have more of their nodes freed.
#pragma once

#include "libcdem/model/build/add_meshes.hpp"
#include "libcdem/model/model.hpp"

namespace cdem {

// The mesh that a block was made of, in the order it has in the model, to build it again; with its own freed nodes alone
// where none are given. freed, joined: as below.
MeshSeed mesh_seed(const Model& old, int block, const std::vector<char>& freed = {},
                   const std::vector<char>& joined = {});

// All but the mesh parts stays. Tets, outer triangles and blocks keep their numbers; nodes and freed faces get new ones.
// freed: per node of `old`, 1 for those to be freed beside those that are. joined: likewise, 1 for those to be freed no more.
struct FreedModel {
  Model model;
  std::vector<int> tets; // ascending: those around nodes that have been freed or joined
};
FreedModel with_freed_nodes(const Model& old, const std::vector<char>& freed,
                            const std::vector<char>& joined = {});

} // namespace cdem
