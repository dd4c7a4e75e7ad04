#include "libcdem/step/workspace.hpp"

#include "libcdem/step/mesh_forces.hpp"

namespace cdem {

Workspace::Workspace(const Model& model, const State& state, const Conditions& conditions)
    : resolved(resolve(model, state, conditions)), force(model.node_position.size()),
      previous_force(model.node_position.size()), mass(model.node_mass),
      spring_force(model.points.size(), geom::Vec3::Zero()), spring_sums(model.point_chunks.size()),
      node_sums(model.chunks.size()) {
  if (!model.mesh.empty()) {
    position.resize(model.node_position.size());
    partial.resize(model.mesh.partial_node.size());
    face_sums.resize(model.mesh.chunks.size());
    move_positions(model, state, *this, {0, static_cast<std::int64_t>(position.size())});
  }
  for (const Interface& interface : model.interfaces) {
    const Joint& joint = model.joints[interface.joint];
    strength.push_back({joint.cohesion, std::tan(joint.friction_angle), joint.tensile_strength});
    if (!state.bond_damage.empty())
      softening.push_back(softening_law(joint, interface.kn, interface.ks));
  }
  stretch.resize(state.bond_damage.size(), geom::Vec3::Zero());
}

} // namespace cdem
