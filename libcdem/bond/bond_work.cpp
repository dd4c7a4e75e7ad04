#include "libcdem/bond/bond_work.hpp"
#include "libgeom/core/portable.hpp"

#include <cmath>

namespace cdem {

BondWork::BondWork(const Model& model, const State& state)
    : spring_force(model.points.size(), geom::Vec3::Zero()),
      turned_force(model.frames.empty() ? 0 : model.points.size(), geom::Vec3::Zero()),
      stretch(state.bond_damage.size(), geom::Vec3::Zero()), sums(model.point_chunks.size()) {
  for (const Interface& interface : model.interfaces) {
    const Joint joint = joint_of(model, interface);
    strength.push_back({joint.cohesion, geom::portable::tan(joint.friction_angle), joint.tensile_strength});
    if (joint.stiffness_damping > 0)
      damping.resize(model.interfaces.size());
    if (!damping.empty())
      damping[strength.size() - 1] = joint.stiffness_damping;
    if (!state.bond_damage.empty())
      softening.push_back(softening_law(joint, interface.kn, interface.ks));
  }
}

} // namespace cdem
