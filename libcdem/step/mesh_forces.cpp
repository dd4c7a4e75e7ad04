#include "libcdem/step/mesh_forces.hpp"

#include "libcdem/bond/cohesive_faces.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/element/face_jumps.hpp"
#include "libcdem/element/finite_volume.hpp"
#include "libcdem/element/nodal_averages.hpp"
#include "libcdem/parallel/simd.hpp"

namespace cdem {
namespace {

// The nodes of a chunk side by side: they stay in a near cache while its tets and faces ask for them again and again.
struct Around {
  std::vector<Node> position, displacement, velocity, force; // per place
  std::vector<JumpBatch> jumps;                              // per batch of tets
  std::vector<StressBatch> stress_before;                    // Pa, likewise
};

std::int64_t first_mesh_chunk(const Model& model) {
  return static_cast<std::int64_t>(model.chunks.size() - model.mesh.chunks.size());
}

struct NearArrays {
  Node *position, *displacement, *velocity, *force; // displacement: null where no bond asks for it
};

// Reads one node. An undeformed position has three numbers, which are read one by one.
CDEM_INLINE void fetch_node(const geom::Vec3& undeformed, const Node& displacement, const Node& velocity,
                            std::int64_t place, const NearArrays& near) {
  const simd::Quad x = {undeformed[0], undeformed[1], undeformed[2], 0};
  const simd::Quad u = simd::load(displacement);
  if (near.displacement)
    simd::store(near.displacement[place], u);
  simd::store(near.position[place], x + u);
  simd::store(near.velocity[place], simd::load(velocity));
  simd::store(near.force[place], simd::Quad{});
}

CDEM_INLINE void fetch_kernel(const geom::Vec3* undeformed, const Node* displacement, const Node* velocity,
                              Range own, const int* others, std::int64_t count, const NearArrays& to) {
  const NearArrays near = to;
  for (std::int64_t i = 0; i < own.size(); ++i)
    fetch_node(undeformed[own.begin + i], displacement[own.begin + i], velocity[own.begin + i], i, near);
  for (std::int64_t i = 0; i < count; ++i)
    fetch_node(undeformed[others[i]], displacement[others[i]], velocity[others[i]], own.size() + i, near);
}

NearArrays fetch(const Model& model, const State& state, const MeshChunk& chunk, Around& near) {
  const auto places = static_cast<std::size_t>(chunk.places());
  if (near.force.size() < places)
    for (std::vector<Node>* array : {&near.position, &near.displacement, &near.velocity, &near.force})
      array->resize(places);
  const NearArrays at{near.position.data(), chunk.faces > 0 ? near.displacement.data() : nullptr,
                      near.velocity.data(), near.force.data()};
  simd::best<fetch_kernel>(model.node_position.data(), state.displacement.data(), state.velocity.data(),
                           chunk.nodes, model.mesh.others.data() + chunk.others.begin, chunk.others.size(),
                           at);
  return at;
}

// What the chunk before `index` will read from afar: the step goes through chunks from the last to the first.
ReadAhead reads_of_chunk_before(const Model& model, const State& state, const Workspace& work,
                                std::int64_t index) {
  ReadAhead ahead;
  if (index == 0)
    return ahead;
  const MeshChunk& chunk = model.mesh.chunks[index - 1];
  const std::int64_t node = chunk.nodes.begin, nodes = chunk.nodes.size();
  ahead.add(model.node_position.data() + node, nodes);
  ahead.add(state.displacement.data() + node, nodes);
  ahead.add(state.velocity.data() + node, nodes);
  ahead.add(model.mesh.batches.data() + chunk.batches.begin, chunk.batches.size());
  ahead.add(state.stress.data() + chunk.batches.begin, chunk.batches.size());
  ahead.add(model.mesh.faces.data() + chunk.face_batches.begin, chunk.face_batches.size());
  ahead.add(state.faces.data() + chunk.face_batches.begin, chunk.face_batches.size());
  ahead.add(model.node_mass.data() + node, nodes);
  const int* const others = model.mesh.others.data() + chunk.others.begin;
  ahead.add_at(model.node_position.data(), others, chunk.others.size());
  ahead.add_at(state.displacement.data(), others, chunk.others.size());
  ahead.add_at(state.velocity.data(), others, chunk.others.size());
  if (chunk.stars)
    add_bond_reads(model, work.bond, first_mesh_chunk(model) + index - 1, ahead);
  return ahead;
}

// Counts the lanes of the last batch that hold a tet.
int last_lanes_of(const MeshChunk& chunk) {
  return static_cast<int>(chunk.tets.size() - (chunk.batches.size() - 1) * lanes);
}

// The stress of tets of rigid blocks in a chunk of which others deform: it stands in the directions they were made rigid
// in, and is put back behind the kernel.
class StressOfRigid {
public:
  StressOfRigid(const Model& model, State& state, const MeshChunk& chunk) : model_(model), state_(state) {
    if (model.rigid.empty())
      return;
    for (std::int64_t b = chunk.blocks.begin; b < chunk.blocks.end; ++b)
      if (model.blocks[b].rigid >= 0)
        for (int t = model.blocks[b].tet_begin; t < model.blocks[b].tet_end; ++t)
          kept_.emplace_back(t, mesh_stress(model, state, t));
  }
  ~StressOfRigid() {
    for (const auto& [tet, stress] : kept_)
      set_mesh_stress(model_, state_, tet, stress);
  }
  StressOfRigid(const StressOfRigid&) = delete;
  StressOfRigid& operator=(const StressOfRigid&) = delete;

private:
  const Model& model_;
  State& state_;
  std::vector<std::pair<int, Stress>> kept_;
};

} // namespace

ReadAhead shared_reads_of(const Model& model, const State& state, const Workspace& work, std::int64_t index) {
  ReadAhead ahead;
  if (index >= static_cast<std::int64_t>(model.mesh.chunks.size()))
    return ahead;
  const MeshChunk& chunk = model.mesh.chunks[index];
  const std::int64_t node = chunk.inner_end, nodes = chunk.nodes.end - node;
  const int* const begin = model.mesh.share_begin.data() + chunk.share_begin;
  ahead.add_at(work.partial.data(), model.mesh.shares.data() + begin[0], begin[nodes] - begin[0]);
  ahead.add(state.displacement.data() + node, nodes);
  ahead.add(state.velocity.data() + node, nodes);
  ahead.add(model.node_mass.data() + node, nodes);
  return ahead;
}

const Node* mesh_forces(const Model& model, State& state, Workspace& work, std::int64_t index,
                        bool breaking) {
  thread_local Around near;
  const MeshChunk& chunk = model.mesh.chunks[index];
  const Body& body = model.bodies[model.blocks[chunk.block].body];
  const NearArrays at = fetch(model, state, chunk, near);
  ReadAhead ahead = reads_of_chunk_before(model, state, work, index);
  ahead.spread(chunk.batches.size() + chunk.face_batches.size());
  const int last_lanes = last_lanes_of(chunk);
  TetDamping damping;
  if (work.damped && body.material.stiffness_damping > 0)
    damping = {body.material.stiffness_damping, state.viscous_stress.data() + chunk.batches.begin};
  FaceSums& sums = work.face_sums[index];
  sums.plastic = 0;
  PlasticTets plastic;
  if (!body.plasticity.empty())
    plastic = {&body.plasticity, model.mesh.plastic_law.data() + chunk.batches.begin * lanes,
               state.plastic_strain.data() + chunk.batches.begin, &sums.plastic};
  const StressOfRigid stress_of_rigid(model, state, chunk);
  const FaceSides sides{model.mesh.sides.data() + chunk.side_batches.begin, chunk.side_batches.size(),
                        chunk.batches.size(), state.faces.data()};
  const bool changes_strain = sides.count > 0 || plastic.laws;
  if (changes_strain) {
    near.jumps.resize(static_cast<std::size_t>(chunk.batches.size()));
    find_jumps(sides, at.position, at.velocity, work.strain_step, near.jumps.data());
  }
  const AveragedTets averaged{model.mesh.batches.data() + chunk.batches.begin, chunk.batches.size(),
                              last_lanes, chunk.places(), at.position};
  if (plastic.laws)
    add_volume_averages(averaged, at.velocity, work.strain_step, near.jumps.data());
  StressBatch* const stress = state.stress.data() + chunk.batches.begin;
  const bool watched = breaking && work.watch && work.watch->looks_at(index);
  const bool rises = watched && work.strain_step > 0 && work.watch->has_held_faces(index);
  if (rises)
    near.stress_before.assign(stress, stress + chunk.batches.size());
  sums.damping = finite_volume_forces(
      model.mesh.batches.data() + chunk.batches.begin, chunk.batches.size(), last_lanes, at.position,
      at.velocity, changes_strain ? near.jumps.data() : nullptr, work.strain_step,
      tet_stiffness(body.material), damping, plastic, stress, at.force, ahead);
  if (watched) {
    work.watch->look(chunk, index, stress, rises ? near.stress_before.data() : nullptr, work.near);
    if (work.strain_step > 0)
      for (std::int64_t b = chunk.batches.begin; b < chunk.batches.end; ++b)
        if (work.near.bits[b] != 0)
          std::fill_n(state.near_at[b].time, lanes, state.time);
  }
  if (plastic.laws)
    add_pressure_averages(averaged, stress, at.force);
  if (sides.count > 0)
    add_side_forces(sides, at.position, stress, damping.viscous, at.force);
  sums.friction = sums.breaking = sums.applied2 = 0;
  sums.crack = {};
  sums.broken.clear();
  sums.pushes.clear();
  sums.astray = -1;
  sums.hands_over = false;
  if (chunk.faces > 0) {
    const FaceMotion motion{at.position, at.displacement, at.velocity, work.strain_step};
    const int number = model.blocks[chunk.block].body;
    FaceLaw law = face_law(body);
    law.hands_over = model.surface.joint.count({number, number}) > 0;
    law.hand_over_due = work.hand_over_due;
    if (!model.mesh.strength.empty())
      law.own = model.mesh.strength.data() + chunk.face_batches.begin;
    const FaceBatch* const faces = model.mesh.faces.data() + chunk.face_batches.begin;
    FaceStateBatch* const face_state = state.faces.data() + chunk.face_batches.begin;
    if (body.bonding.is_cohesive()) {
      cohesive_face_forces(faces, chunk.faces, motion, law, FaceJoints(model, state, chunk), breaking,
                           face_state, state.cohesive.data() + chunk.face_batches.begin * lanes, at.force,
                           sums, work.near.pull2.data() + chunk.face_batches.begin * lanes);
      add_crack_pressures(model, state, chunk, work.resolved.cracks, motion, at.force, sums);
    } else
      face_bond_forces(faces, chunk.face_batches.size(), chunk.faces, motion, law, breaking, face_state,
                       state.face_slip.data(), at.force, sums, ahead);
  }
  if (chunk.stars) {
    add_bond_forces(model, work.bond.force(), chunk.nodes, at.force);
    return at.force;
  }
  const Node* const shared = at.force + (chunk.inner_end - chunk.nodes.begin);
  geom::Vec3* const partial = work.partial.data() + chunk.partial.begin;
  for (std::int64_t i = 0; i < chunk.partial.size(); ++i)
    partial[i] = {shared[i].x, shared[i].y, shared[i].z};
  return at.force;
}

void strain_meshes(const Model& model, State& state, const std::vector<Node>& moved, int threads) {
  std::vector<Node> velocity = moved; // m/s, for a step of one second
  std::swap(state.velocity, velocity);
  for_chunks(static_cast<std::int64_t>(model.mesh.chunks.size()), threads, [&](std::int64_t index) {
    thread_local Around near;
    const MeshChunk& chunk = model.mesh.chunks[index];
    const Body& body = model.bodies[model.blocks[chunk.block].body];
    if (!body.bonding.is_cohesive() || is_rigid(model, chunk))
      return;
    const NearArrays at = fetch(model, state, chunk, near);
    const StressOfRigid stress_of_rigid(model, state, chunk);
    near.jumps.resize(static_cast<std::size_t>(chunk.batches.size()));
    const FaceSides sides{model.mesh.sides.data() + chunk.side_batches.begin, chunk.side_batches.size(),
                          chunk.batches.size(), state.faces.data()};
    find_jumps(sides, at.position, at.velocity, 1, near.jumps.data());
    ReadAhead ahead;
    finite_volume_forces(model.mesh.batches.data() + chunk.batches.begin, chunk.batches.size(),
                         last_lanes_of(chunk), at.position, at.velocity, near.jumps.data(), 1,
                         tet_stiffness(body.material), {}, {}, state.stress.data() + chunk.batches.begin,
                         at.force, ahead);
  });
  std::swap(state.velocity, velocity);
}

} // namespace cdem
