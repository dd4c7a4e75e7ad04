#include "libcdem/step/forces.hpp"

#include "libcdem/element/small_strain.hpp"

namespace cdem {
namespace {

void clear_forces(Workspace& work, Range nodes) {
  std::fill(work.force.begin() + nodes.begin, work.force.begin() + nodes.end, Node{});
}

void add_spring_forces(const Model& model, Workspace& work, Range nodes) {
  for (std::int64_t node = nodes.begin; node < nodes.end; ++node) {
    Node& f = work.force[node];
    for (std::int64_t i = model.bond_begin[node]; i < model.bond_begin[node + 1]; ++i) {
      const BondOnNode& bond = model.bonds_on_nodes[i];
      const geom::Vec3& spring = work.spring_force[bond.point];
      f.x += bond.weight * spring.x();
      f.y += bond.weight * spring.y();
      f.z += bond.weight * spring.z();
    }
  }
}

void add(std::vector<Node>& force, const std::vector<Node>& more, Range nodes) {
  for (std::int64_t node = nodes.begin; node < nodes.end; ++node) {
    force[node].x += more[node].x;
    force[node].y += more[node].y;
    force[node].z += more[node].z;
  }
}

// The owner of a node adds the partial forces of all chunks that touch it, in order.
void add_mesh_forces(const Model& model, Workspace& work, Range nodes) {
  const MeshData& mesh = model.mesh;
  if (mesh.empty())
    return;
  for (std::int64_t node = std::max<std::int64_t>(nodes.begin, mesh.first_node); node < nodes.end; ++node) {
    Node& f = work.force[node];
    const int* share = mesh.shares.data() + mesh.share_begin[node - mesh.first_node];
    const int* const end = mesh.shares.data() + mesh.share_begin[node - mesh.first_node + 1];
    for (; share != end; ++share) {
      const Node& p = work.partial[*share];
      f.x += p.x;
      f.y += p.y;
      f.z += p.z;
    }
  }
}

} // namespace

void net_forces(const Model& model, const State& state, Workspace& work, const BlockChunk& chunk) {
  clear_forces(work, chunk.nodes);
  add_small_strain_forces(model.batches.data() + chunk.batches.begin, chunk.batches.size(),
                          state.displacement.data(), work.force.data());
  add_mesh_forces(model, work, chunk.nodes);
  add_spring_forces(model, work, chunk.nodes);
  if (work.resolved.has_initial_stress)
    add(work.force, work.resolved.internal, chunk.nodes);
  add(work.force, work.resolved.external, chunk.nodes);
}

} // namespace cdem
