#include "libcdem/bond/bond_work.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

InterfaceLaw law_of_interface(const Model& model, const Interface& interface) {
  const Joint& joint = model.joints[interface.joint];
  if (!has_law(joint.law))
    return {};
  return {&joint.law, {interface.kn, interface.ks, geom::portable::tan(joint.friction_angle)}};
}

BondWork::BondWork(const Model& model, const State& state)
    : spring_force(model.points.size(), geom::Vec3::Zero()),
      acting_force(model.frames.empty() && state.water_pressure.empty() ? 0 : model.points.size(),
                   geom::Vec3::Zero()),
      viscous(model.frames.empty() ? 0 : model.points.size(), geom::Vec3::Zero()),
      stretch(std::max(state.bond_damage.size(), state.joint_history.size()), geom::Vec3::Zero()),
      sums(model.point_chunks.size()) {
  std::vector<char> plain;
  for (const Interface& interface : model.interfaces) {
    const Joint joint = joint_of(model, interface);
    strength.push_back({joint.cohesion, geom::portable::tan(joint.friction_angle), joint.tensile_strength});
    if (joint.stiffness_damping > 0)
      damping.resize(model.interfaces.size());
    if (!damping.empty())
      damping[strength.size() - 1] = joint.stiffness_damping;
    if (!state.bond_damage.empty())
      softening.push_back(softening_law(joint, interface.kn, interface.ks));
    if (!state.joint_history.empty())
      laws.push_back(law_of_interface(model, interface));
    plain.push_back((softening.empty() || !softening.back().softens) && (laws.empty() || !laws.back().law));
  }
  batches = spring_batches(model, strength, plain);
  const auto first_behind = [&](std::int64_t node) { // springs stand in the order of their later blocks
    return std::partition_point(model.points.begin(), model.points.end(),
                                [&](const BondPoint& point) { return point.node_b[0] < node; }) -
           model.points.begin();
  };
  for (const BlockChunk& chunk : model.chunks)
    new_springs.push_back({first_behind(chunk.nodes.begin), first_behind(chunk.nodes.end)});
  find_idle_springs(model, state, *this);
}

} // namespace cdem
