#include "libcdem/step/workspace.hpp"

#include "libcdem/contact/search.hpp"

namespace cdem {

Workspace::Workspace(const Model& model, const State& state, const Conditions& conditions)
    : resolved(resolve(model, state, conditions)),
      force(model.mesh.empty() ? model.node_position.size()
                               : static_cast<std::size_t>(model.mesh.first_node)),
      spring_force(model.points.size(), geom::Vec3::Zero()),
      turned_force(model.frames.empty() ? 0 : model.points.size(), geom::Vec3::Zero()),
      spring_sums(model.point_chunks.size()), node_sums(model.chunks.size()), rigid_sums(model.rigid.size()) {
  if (!model.mesh.empty()) {
    partial.resize(static_cast<std::size_t>(model.mesh.chunks.back().partial.end));
    face_sums.resize(model.mesh.chunks.size());
  }
  if (!model.surface.empty())
    contact_force.resize(model.node_position.size());
  start_contact(model, contact);
  for (const Interface& interface : model.interfaces) {
    const Joint& joint = model.joints[interface.joint];
    strength.push_back({joint.cohesion, std::tan(joint.friction_angle), joint.tensile_strength});
    if (!state.bond_damage.empty())
      softening.push_back(softening_law(joint, interface.kn, interface.ks));
  }
  stretch.resize(state.bond_damage.size(), geom::Vec3::Zero());
}

} // namespace cdem
