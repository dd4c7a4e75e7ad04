#include "libcdem/step/mesh_forces.hpp"

#include "libcdem/model/add_meshes.hpp"

namespace cdem {

void mesh_forces(const Model& model, State& state, Workspace& work, std::int64_t index, bool breaking) {
  const MeshChunk& chunk = model.mesh.chunks[index];
  const Body& body = model.bodies[model.blocks[chunk.block].body];
  Node* const partial = work.partial.data() + chunk.partial.begin;
  std::fill(partial, partial + chunk.partial.size(), Node{});
  const int last_lanes = static_cast<int>(chunk.tets.size() - (chunk.batches.size() - 1) * lanes);
  finite_volume_forces(model.mesh.batches.data() + chunk.batches.begin, chunk.batches.size(), last_lanes,
                       work.position.data(), state.velocity.data(), work.strain_step,
                       tet_stiffness(body.material), state.stress.data() + chunk.batches.begin, partial);
  FaceSums& sums = work.face_sums[index];
  sums.friction = sums.breaking = 0;
  sums.broken.clear();
  if (chunk.faces == 0)
    return;
  face_bond_forces(model.mesh.faces.data() + chunk.face_batches.begin, chunk.face_batches.size(), chunk.faces,
                   work.position.data(), state.displacement.data(), face_law(body), breaking,
                   state.faces.data() + chunk.face_batches.begin, partial, sums);
}

void move_positions(const Model& model, const State& state, Workspace& work, Range nodes) {
  if (work.position.empty())
    return;
  for (std::int64_t i = nodes.begin; i < nodes.end; ++i) {
    const geom::Vec3& x = model.node_position[i];
    const Node& u = state.displacement[i];
    work.position[i] = {x.x() + u.x, x.y() + u.y, x.z() + u.z, 0};
  }
}

} // namespace cdem
