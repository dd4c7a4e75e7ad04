#include "libcdem/procedure/turn_rigid.hpp"

#include "libcdem/contact/response/contact_point.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/model/build/rigid_bodies.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/state/places.hpp"

#include <algorithm>
#include <iterator>

namespace cdem {
namespace {

void set_offsets(const Model& model, State& state, const Block& block, const geom::Vec3& centroid) {
  for (int i = block.node_begin; i < block.node_end; ++i)
    state.rigid_offset[i] = node(model.node_position[i] + vec(state.displacement[i]) - centroid);
}

RigidState motion_of(const Model& model, const State& state, const RigidShape& shape) {
  const Block& block = model.blocks[shape.body.block];
  geom::Vec3 momentum = geom::Vec3::Zero(), angular = geom::Vec3::Zero();
  for (int i = block.node_begin; i < block.node_end; ++i)
    momentum += model.node_mass[i] * vec(state.velocity[i]);
  const geom::Vec3 velocity = momentum / shape.body.mass;
  for (int i = block.node_begin; i < block.node_end; ++i)
    angular += model.node_mass[i] * (model.node_position[i] + vec(state.displacement[i]) - shape.centroid)
                                        .cross(vec(state.velocity[i]) - velocity);
  RigidState motion;
  motion.centroid = three_of(shape.centroid);
  motion.velocity = three_of(velocity);
  // The spin is kept, that of the masses at the nodes; the solid's moment of inertia is smaller.
  motion.angular_momentum = three_of(shape.body.inertia * shape.nodal_inertia.inverse() * angular);
  return motion;
}

// What stood in the old directions is turned to the present ones; the slip of broken faces turns with them by itself.
void turn_stress(const Model& model, State& state, int block, const geom::Mat3& rotation) {
  const Block& b = model.blocks[block];
  for (int tet = b.tet_begin; tet < b.tet_end; ++tet)
    set_mesh_stress(model, state, tet, turned(rotation, mesh_stress(model, state, tet)));
}

// The preload of freed faces too.
void turn_preloads(const Model& model, State& state, const std::vector<char>& leaves) {
  each_face(model.mesh, [&](const MeshChunk& chunk, std::int64_t batch, int lane) {
    const int rigid = model.blocks[chunk.block].rigid;
    if (rigid < 0 || !leaves[rigid] || state.faces[batch].preloaded[lane] == 0)
      return;
    const geom::Mat3 turn = rotation(state.rigid[rigid]);
    for (CohesiveFace::Vector& force : state.cohesive[batch * lanes + lane].preload)
      force = three_of(turn * vec(force));
  });
}

void clear_viscous_stress(const Model& model, State& state, const Block& block) {
  for (int tet = block.tet_begin; tet < block.tet_end; ++tet) {
    const int slot = model.mesh.tet_slot[tet - model.mesh.first_tet];
    for (auto& component : state.viscous_stress[slot / lanes].component)
      component[slot % lanes] = 0;
  }
}

struct Rigid {
  RigidBody body;
  RigidState motion;
};

// Model::rigid and State::rigid anew. Contacts keep their stiffness, and with it their force: a rigid body lends none of its
// mesh to a body that deforms.
void replace(Model& model, State& state, std::vector<Rigid>&& all) {
  std::vector<double> stiffness;
  for (const Contact& c : state.contacts)
    stiffness.push_back(law_of(model, c).kn);
  std::sort(all.begin(), all.end(),
            [](const Rigid& a, const Rigid& b) { return a.body.block < b.body.block; });
  for (Block& block : model.blocks)
    block.rigid = -1;
  model.rigid.clear();
  state.rigid.clear();
  for (const Rigid& rigid : all) {
    model.blocks[rigid.body.block].rigid = static_cast<int>(model.rigid.size());
    model.rigid.push_back(rigid.body);
    state.rigid.push_back(rigid.motion);
  }
  if (all.empty())
    state.rigid_offset.clear();
  else
    state.rigid_offset.resize(model.node_position.size());
  for (std::size_t i = 0; i < stiffness.size(); ++i)
    if (law_of(model, state.contacts[i]).kn != stiffness[i])
      state.contacts[i].stiffness = stiffness[i];
}

} // namespace

void place_nodes(const Model& model, State& state, int rigid) {
  const RigidState& motion = state.rigid[rigid];
  const RigidBody& body = model.rigid[rigid];
  const Block& block = model.blocks[body.block];
  const geom::Mat3 r = rotation(motion);
  const geom::Vec3 w = spin(body, motion, 0), centroid = vec(motion.centroid),
                   velocity = vec(motion.velocity);
  for (int i = block.node_begin; i < block.node_end; ++i) {
    const geom::Vec3 arm = r * vec(state.rigid_offset[i]);
    state.displacement[i] = node(centroid + arm - model.node_position[i]);
    state.velocity[i] = node(velocity + w.cross(arm));
  }
}

std::int64_t set_rigid(Model& model, State& state, const std::vector<int>& blocks) {
  std::vector<int> fresh;
  std::copy_if(blocks.begin(), blocks.end(), std::back_inserter(fresh),
               [&](int b) { return model.blocks[b].rigid < 0; });
  if (fresh.empty())
    return 0;
  const double before = energy(model, state).total();
  std::vector<Rigid> all;
  for (std::size_t i = 0; i < model.rigid.size(); ++i)
    all.push_back({model.rigid[i], state.rigid[i]});
  state.rigid_offset.resize(model.node_position.size());
  for (const int b : fresh) {
    const RigidShape shape = rigid_shape(model, b, state.displacement.data());
    set_offsets(model, state, model.blocks[b], shape.centroid);
    all.push_back({shape.body, motion_of(model, state, shape)});
  }
  replace(model, state, std::move(all));
  if (!state.viscous_stress.empty())
    for (const int b : fresh)
      clear_viscous_stress(model, state, model.blocks[b]);
  for (const int b : fresh)
    place_nodes(model, state, model.blocks[b].rigid);
  state.spent.fictitious += before - energy(model, state).total();
  return static_cast<std::int64_t>(fresh.size());
}

std::int64_t set_deformable(Model& model, State& state, const std::vector<int>& blocks) {
  const double before = energy(model, state).total();
  std::vector<char> leaves(model.rigid.size(), 0);
  std::int64_t changed = 0;
  for (const int b : blocks) {
    const int rigid = model.blocks[b].rigid;
    if (rigid < 0)
      continue;
    place_nodes(model, state, rigid);
    turn_stress(model, state, b, rotation(state.rigid[rigid]));
    leaves[rigid] = 1;
    ++changed;
  }
  if (changed == 0)
    return 0;
  turn_preloads(model, state, leaves);
  std::vector<Rigid> stay;
  for (std::size_t i = 0; i < leaves.size(); ++i)
    if (!leaves[i])
      stay.push_back({model.rigid[i], state.rigid[i]});
  for (const int b : blocks) {
    const Block& block = model.blocks[b];
    std::fill(state.rigid_offset.begin() + block.node_begin, state.rigid_offset.begin() + block.node_end,
              Node{});
  }
  replace(model, state, std::move(stay));
  state.spent.fictitious += before - energy(model, state).total();
  return changed;
}

} // namespace cdem
