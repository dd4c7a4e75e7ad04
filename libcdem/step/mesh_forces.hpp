// Forces of one chunk of a mesh: its tets and its bonded faces. Chunks may run side by side: each reads nodes of its
// own and of others, gives those of its inner nodes back, and leaves the rest in its own slice of the partial forces.
#pragma once

#include "libcdem/parallel/read_ahead.hpp"
#include "libcdem/step/workspace.hpp"

namespace cdem {

// Advances the stress by Workspace::strain_step, the step that the stress stands behind the nodes. Returns the forces
// at the chunk's places, N, of which those of its inner nodes are complete but for loads; they stand until the thread
// does its next chunk.
const Node* mesh_forces(const Model&, State&, Workspace&, std::int64_t chunk, bool breaking);

// Advances the stress of the meshes of cohesive bodies by a displacement (m, n_nodes) that has just been added to the state's
// and that no step knows of.
void strain_meshes(const Model&, State&, const std::vector<Node>& moved, int threads);

// What each_shared_force and a move of the chunk's other nodes will read, for the chunk before it to ask for.
ReadAhead shared_reads_of(const Model&, const State&, const Workspace&, std::int64_t chunk);

// visit(nodes, forces) for the other nodes of a chunk, some at a time: the sums of what all chunks left for them, in
// order. After mesh_forces of every chunk.
template <class Visit>
void each_shared_force(const MeshData& mesh, const Workspace& work, const MeshChunk& chunk, ReadAhead ahead,
                       const Visit& visit) {
  constexpr std::int64_t at_once = 64;
  Node sums[at_once];
  const int* end = mesh.share_begin.data() + chunk.share_begin;
  for (std::int64_t node = chunk.inner_end; node < chunk.nodes.end; node += at_once) {
    const Range nodes{node, std::min(chunk.nodes.end, node + at_once)};
    for (std::int64_t i = 0; i < nodes.size(); ++i, ++end) {
      Node f;
      for (const int *share = mesh.shares.data() + end[0], *last = mesh.shares.data() + end[1]; share != last;
           ++share) {
        const geom::Vec3& p = work.partial[*share];
        f.x += p[0];
        f.y += p[1];
        f.z += p[2];
      }
      sums[i] = f;
      ahead.some();
    }
    visit(nodes, static_cast<const Node*>(sums));
  }
}

} // namespace cdem
