#include "libcdem/bond/bond_work.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdem {

InterfaceLaw law_of_interface(const Model& model, const Interface& interface) {
  const Joint& joint = model.joints[interface.joint];
  if (!has_law(joint.law))
    return {};
  return {&joint.law, {interface.kn, interface.ks, geom::portable::tan(joint.friction_angle)}};
}

namespace {

// m, of a block across an interface.
double height_of(const Block& block, const geom::Vec3& normal) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const geom::Vec3& vertex : block.shape.vertices) {
    low = std::min(low, vertex.dot(normal));
    high = std::max(high, vertex.dot(normal));
  }
  return high - low;
}

// 1/s, a tenth of omega: of the first vibration of a block of the height h across a layer of springs,
//
//   1 / omega^2 = rho h / kn + (2 h / pi)^2 rho / E
//
// by Dunkerley's rule: a rigid block on the layer, and a rod on a rigid ground. It is exact where one of them is small, and lies at
// most 2.5 % below that of a rod on springs. Both blocks move: their omega^2 add.
double rest_rate_of(const Model& model, const Interface& interface) {
  constexpr double time_of_means = 10, half_pi = 1.57079632679489661923;
  double omega2 = 0;
  for (const int number : {interface.block_a, interface.block_b}) {
    const Block& block = model.blocks[number];
    if (block.rigid >= 0)
      continue;
    const Elastic& material = model.bodies[block.body].material;
    const double h = height_of(block, interface.normal);
    omega2 +=
        1 / (material.density * h * (1 / interface.kn + h / (half_pi * half_pi * material.youngs_modulus)));
  }
  return std::sqrt(omega2) / time_of_means;
}

} // namespace

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
    rest_rate.push_back(rest_rate_of(model, interface));
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

void BondWork::add_dashpots() {
  viscous.resize(spring_force.size(), geom::Vec3::Zero());
  if (acting_force.empty())
    acting_force = spring_force;
}

} // namespace cdem
