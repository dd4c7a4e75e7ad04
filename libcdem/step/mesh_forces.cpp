#include "libcdem/step/mesh_forces.hpp"

#include "libcdem/model/add_meshes.hpp"
#include "libcdem/parallel/simd.hpp"

namespace cdem {
namespace {

// The nodes of a chunk side by side: they stay in a near cache while its tets and faces ask for them again and again.
struct Near {
  std::vector<Node> position, displacement, velocity, force; // per place
};

void fetch(const Model& model, const State& state, std::int64_t node, std::int64_t place, Near& near) {
  const geom::Vec3& x = model.node_position[node];
  const simd::Quad undeformed = {x.x(), x.y(), x.z(), 0};
  const simd::Quad u = simd::load(state.displacement[node]);
  simd::store(near.displacement[place], u);
  simd::store(near.position[place], undeformed + u);
  simd::store(near.velocity[place], simd::load(state.velocity[node]));
}

void fetch(const Model& model, const State& state, const MeshChunk& chunk, Near& near) {
  const auto places = static_cast<std::size_t>(chunk.places());
  if (near.force.size() < places)
    for (std::vector<Node>* array : {&near.position, &near.displacement, &near.velocity, &near.force})
      array->resize(places);
  for (std::int64_t i = 0; i < chunk.nodes.size(); ++i)
    fetch(model, state, chunk.nodes.begin + i, i, near);
  const int* const others = model.mesh.others.data() + chunk.others.begin;
  for (std::int64_t i = 0; i < chunk.others.size(); ++i)
    fetch(model, state, others[i], chunk.nodes.size() + i, near);
  std::fill(near.force.begin(), near.force.begin() + chunk.places(), Node{});
}

} // namespace

const Node* mesh_forces(const Model& model, State& state, Workspace& work, std::int64_t index,
                        bool breaking) {
  thread_local Near near;
  const MeshChunk& chunk = model.mesh.chunks[index];
  const Body& body = model.bodies[model.blocks[chunk.block].body];
  fetch(model, state, chunk, near);
  const int last_lanes = static_cast<int>(chunk.tets.size() - (chunk.batches.size() - 1) * lanes);
  TetDamping damping;
  if (work.damped && body.material.stiffness_damping > 0)
    damping = {body.material.stiffness_damping, state.viscous_stress.data() + chunk.batches.begin};
  FaceSums& sums = work.face_sums[index];
  sums.damping = finite_volume_forces(model.mesh.batches.data() + chunk.batches.begin, chunk.batches.size(),
                                      last_lanes, near.position.data(), near.velocity.data(),
                                      work.strain_step, tet_stiffness(body.material), damping,
                                      state.stress.data() + chunk.batches.begin, near.force.data());
  sums.friction = sums.breaking = 0;
  sums.broken.clear();
  sums.astray = -1;
  sums.hands_over = false;
  if (chunk.faces > 0) {
    const FaceMotion motion{near.position.data(), near.displacement.data(), near.velocity.data(),
                            work.strain_step};
    const int number = model.blocks[chunk.block].body;
    FaceLaw law = face_law(body);
    law.hands_over = model.surface.joint.count({number, number}) > 0;
    face_bond_forces(model.mesh.faces.data() + chunk.face_batches.begin, chunk.face_batches.size(),
                     chunk.faces, motion, law, breaking, state.faces.data() + chunk.face_batches.begin,
                     state.face_slip.data(), near.force.data(), sums);
  }
  std::copy(near.force.begin() + (chunk.inner_end - chunk.nodes.begin), near.force.begin() + chunk.places(),
            work.partial.begin() + chunk.partial.begin);
  return near.force.data();
}

} // namespace cdem
