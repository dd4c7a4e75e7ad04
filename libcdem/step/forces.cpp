#include "libcdem/step/forces.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/contact/contact_forces.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/step/mesh_forces.hpp"

#include <algorithm>

namespace cdem {
namespace {

// What the chunk before `index` reads: the step goes through chunks from the last to the first.
ReadAhead reads_before(const Model& model, const State& state, const Workspace& work, std::int64_t index) {
  ReadAhead ahead;
  if (index == 0)
    return ahead;
  const BlockChunk& chunk = model.chunks[index - 1];
  const std::int64_t node = chunk.nodes.begin, nodes = chunk.nodes.size();
  ahead.add(model.batches.data() + chunk.batches.begin, chunk.batches.size());
  ahead.add(state.displacement.data() + node, nodes);
  ahead.add(state.velocity.data() + node, nodes);
  ahead.add(model.node_mass.data() + node, nodes);
  add_bond_reads(model, work.bond, index - 1, ahead);
  return ahead;
}

bool touches_any(const MeshData& mesh, const MeshChunk& chunk, const std::vector<char>& nodes) {
  const auto any = [&](const auto& in, Range range, const auto& is) {
    return std::any_of(in.begin() + range.begin, in.begin() + range.end, is);
  };
  return nodes.empty() || any(nodes, chunk.nodes, [](char is) { return is != 0; }) ||
         any(mesh.others, chunk.others, [&](int node) { return nodes[node] != 0; });
}

void add(Node& force, const Node& more) {
  force.x += more.x;
  force.y += more.y;
  force.z += more.z;
}

} // namespace

const Node* block_forces(const Model& model, const State& state, const Workspace& work, std::int64_t index) {
  thread_local std::vector<Node> force;
  const BlockChunk& chunk = model.chunks[index];
  force.assign(static_cast<std::size_t>(chunk.nodes.size()), Node{});
  ReadAhead ahead = reads_before(model, state, work, index);
  ahead.spread(chunk.batches.size());
  add_small_strain_forces(model.batches.data() + chunk.batches.begin, chunk.batches.size(),
                          state.displacement.data() + chunk.nodes.begin, force.data(), ahead);
  add_bond_forces(model, work.bond.force(), chunk.nodes, force.data());
  return force.data();
}

std::vector<Node> inner_forces(const Model& model, const State& state, Workspace& work, int threads,
                               const std::vector<char>& only) {
  State copy = state; // bookkeeping of springs and faces stays as it is
  contact_forces(model, copy, work.contact, threads);
  for_chunks(static_cast<std::int64_t>(model.point_chunks.size()), threads,
             [&](std::int64_t c) { spring_forces(model, copy, work.bond, c, false); });
  std::vector<Node> force(model.node_position.size());
  for_chunks(static_cast<std::int64_t>(model.mesh.chunks.size()), threads, [&](std::int64_t c) {
    const MeshChunk& chunk = model.mesh.chunks[c];
    if (!touches_any(model.mesh, chunk, only))
      return;
    if (is_rigid(model, chunk)) { // only interfaces pull at its nodes
      if (chunk.stars)
        add_bond_forces(model, work.bond.force(), chunk.nodes, force.data() + chunk.nodes.begin);
      return;
    }
    const Node* const at = mesh_forces(model, copy, work, c, false);
    std::copy(at, at + (chunk.inner_end - chunk.nodes.begin), force.begin() + chunk.nodes.begin);
  });
  for (const MeshChunk& chunk : model.mesh.chunks)
    if (!is_rigid(model, chunk))
      each_shared_force(model.mesh, work, chunk, {}, [&](Range nodes, const Node* at) {
        std::copy(at, at + nodes.size(), force.begin() + nodes.begin);
      });
  for_chunks(static_cast<std::int64_t>(model.chunks.size() - model.mesh.chunks.size()), threads,
             [&](std::int64_t c) {
               const Node* const at = block_forces(model, copy, work, c);
               std::copy(at, at + model.chunks[c].nodes.size(), force.begin() + model.chunks[c].nodes.begin);
             });
  return force;
}

std::vector<Node> net_forces(const Model& model, const State& state, Workspace& work, int threads,
                             const std::vector<char>& only) {
  std::vector<Node> force = inner_forces(model, state, work, threads, only);
  const ResolvedConditions& r = work.resolved;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (!work.contact.loads.force.empty())
      add(force[i], work.contact.loads.force[i]);
    if (!r.internal.empty())
      add(force[i], r.internal[i]);
    if (!r.external.empty())
      add(force[i], r.external[i]);
  }
  return force;
}

} // namespace cdem
