#include "libcdem/step/forces.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/contact/contact_forces.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/step/mesh_forces.hpp"

namespace cdem {
namespace {

void clear_forces(Workspace& work, Range nodes) {
  std::fill(work.force.begin() + nodes.begin, work.force.begin() + nodes.end, Node{});
}

void add(Node& force, const Node& more) {
  force.x += more.x;
  force.y += more.y;
  force.z += more.z;
}

} // namespace

void block_forces(const Model& model, const State& state, Workspace& work, const BlockChunk& chunk) {
  clear_forces(work, chunk.nodes);
  add_small_strain_forces(model.batches.data() + chunk.batches.begin, chunk.batches.size(),
                          state.displacement.data(), work.force.data());
  add_bond_forces(model, work.bond.force(), chunk.nodes, work.force.data() + chunk.nodes.begin);
}

std::vector<Node> net_forces(const Model& model, const State& state, Workspace& work) {
  State copy = state; // bookkeeping of springs and faces stays as it is
  work.strain_step = 0;
  work.contact.due = true;
  contact_forces(model, copy, work.contact, 1);
  for (std::size_t c = 0; c < model.point_chunks.size(); ++c)
    spring_forces(model, copy, work.bond, static_cast<std::int64_t>(c), false);
  std::vector<Node> force(model.node_position.size());
  for (std::size_t c = 0; c < model.mesh.chunks.size(); ++c) {
    const MeshChunk& chunk = model.mesh.chunks[c];
    if (is_rigid(model, chunk)) { // only interfaces pull at its nodes
      if (chunk.stars)
        add_bond_forces(model, work.bond.force(), chunk.nodes, force.data() + chunk.nodes.begin);
      continue;
    }
    const Node* const at = mesh_forces(model, copy, work, static_cast<std::int64_t>(c), false);
    std::copy(at, at + (chunk.inner_end - chunk.nodes.begin), force.begin() + chunk.nodes.begin);
  }
  for (const MeshChunk& chunk : model.mesh.chunks)
    if (!is_rigid(model, chunk))
      each_shared_force(model.mesh, work, chunk, {}, [&](Range nodes, const Node* at) {
        std::copy(at, at + nodes.size(), force.begin() + nodes.begin);
      });
  for (std::size_t c = 0; c < model.chunks.size() - model.mesh.chunks.size(); ++c)
    block_forces(model, copy, work, model.chunks[c]);
  std::copy(work.force.begin(), work.force.end(), force.begin());
  const ResolvedConditions& r = work.resolved;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (!work.contact.force.empty())
      add(force[i], work.contact.force[i]);
    if (!r.internal.empty())
      add(force[i], r.internal[i]);
    if (!r.external.empty())
      add(force[i], r.external[i]);
  }
  return force;
}

} // namespace cdem
