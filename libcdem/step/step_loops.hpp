// The loops of a step over chunks. The caller passes the function that moves nodes: move(nodes, forces, sums) is called
// for a run of nodes once all code that reads their positions has run. `forces` are those of elements and springs,
// beginning with the first node.
//
// One loop computes the forces of a chunk and moves its nodes, since the forces are then still in the cache.
#pragma once

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/step/forces.hpp"
#include "libcdem/step/mesh_forces.hpp"

#include <functional>

namespace cdem {

// Springs between blocks; each chunk of them writes its own forces only.
inline void bond_forces(const Model& model, State& state, Workspace& work, int threads, bool breaking) {
  for_chunks(work.point_chunks(model), threads,
             [&](std::int64_t c) { spring_forces(model, state, work.bond, c, breaking); });
  if (work.shared)
    work.shared->share_springs(work.bond.spring_force, work.bond.acting_force);
}

// Elements, the bonds inside meshes, and the motion of the nodes that no other chunk touches: all of a block, the inner
// ones of a chunk of a mesh. After bond_forces.
template <class Move>
void element_forces(const Model& model, State& state, Workspace& work, int threads, bool breaking,
                    const Move& move) {
  const auto meshes = static_cast<std::int64_t>(model.mesh.chunks.size());
  const auto stars = static_cast<std::int64_t>(model.chunks.size()) - meshes;
  const Range chunks = work.chunks(model);
  for_chunks(chunks.size(), threads, [&](std::int64_t i) {
    const std::int64_t c = chunks.end - 1 - i;
    NodeSums sums;
    if (c < stars) {
      move(model.chunks[c].nodes, block_forces(model, state, work, c), sums);
      work.node_sums[c] = sums;
      return;
    }
    const MeshChunk& chunk = model.mesh.chunks[c - stars];
    if (is_rigid(model, chunk))
      return;
    const Node* const force = mesh_forces(model, state, work, c - stars, breaking);
    sums.applied2 = work.face_sums[c - stars].applied2;
    if (chunk.stars)
      each_deformable_run(model, chunk,
                          [&](Range nodes) { move(nodes, force + (nodes.begin - chunk.nodes.begin), sums); });
    else
      move(Range{chunk.nodes.begin, chunk.inner_end}, force, sums);
    work.node_sums[c] = sums;
  });
  if (work.shared)
    work.shared->share_partial_forces(work.partial);
}

// Some node is touched by several chunks.
inline bool has_shared_nodes(const Model& model) {
  return std::any_of(model.mesh.chunks.begin(), model.mesh.chunks.end(), [](const MeshChunk& chunk) {
    return !chunk.stars && chunk.inner_end < chunk.nodes.end;
  });
}

// Adds the forces of all chunks on the nodes that several of them use, in their order, and moves these nodes. After
// element_forces.
template <class Move>
void shared_node_forces(const Model& model, State& state, Workspace& work, int threads, const Move& move) {
  const auto meshes = static_cast<std::int64_t>(model.mesh.chunks.size());
  const auto stars = static_cast<std::int64_t>(model.chunks.size()) - meshes;
  for_chunks(work.mesh_chunks(model), threads, [&](std::int64_t c) {
    const MeshChunk& chunk = model.mesh.chunks[c];
    if (chunk.stars || is_rigid(model, chunk))
      return;
    NodeSums sums = work.node_sums[stars + c];
    ReadAhead ahead = shared_reads_of(model, state, work, c + 1);
    ahead.spread(chunk.nodes.end - chunk.inner_end);
    each_shared_force(model.mesh, work, chunk, ahead,
                      [&](Range nodes, const Node* force) { move(nodes, force, sums); });
    work.node_sums[stars + c] = sums;
  });
}

// move_rigid(rigid body, sums) moves a body and writes work.rigid_angle; place_rigid(rigid body) then puts its nodes where it
// is. Of relaxations, in which none moves, the latter is empty.
template <class MoveRigid>
void rigid_bodies(const Model& model, State& state, Workspace& work, int threads, const MoveRigid& move_rigid,
                  const std::function<void(int)>& place_rigid) {
  const auto each = [&](const std::vector<int>& bodies, const auto& act) {
    for_chunks(static_cast<std::int64_t>(bodies.size()), threads, [&](std::int64_t i) { act(bodies[i]); });
  };
  const auto move = [&](int body) {
    NodeSums sums;
    move_rigid(body, sums);
    work.rigid_sums[body] = sums;
  };
  if (work.shared) {
    each(work.shared->moved_bodies(), move);
    if (!place_rigid)
      return;
    work.shared->share_rigid(state, work.rigid_angle);
    each(work.shared->placed_bodies(), place_rigid);
    return;
  }
  for_chunks(static_cast<std::int64_t>(model.rigid.size()), threads, [&](std::int64_t body) {
    move(static_cast<int>(body));
    if (place_rigid)
      place_rigid(static_cast<int>(body));
  });
}

// Over all chunks and rigid bodies of all ranks, exactly, then rounded. All ranks call it together;
// tellers: a number that is summed over them in the same message.
NodeSums sums_of(const Workspace&, std::int64_t& tellers);

} // namespace cdem
