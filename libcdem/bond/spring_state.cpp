// Forces and energies of springs as they stand, without a step.
#include "libcdem/bond/interface_frame.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>

namespace cdem {
namespace {

bool damaged(const State& state, int p) {
  return !state.bond_damage.empty() && is_intact(state.bond_mode[p]) && state.bond_damage[p] > 0;
}

// The present response of a damaged bond, nothing advanced.
SofteningResponse<double> damaged_response(const SofteningLaw& law, const BondPoint& point,
                                           const State& state, int p, const geom::Vec3& stretch) {
  return softening_response<double>(law, triple(point.normal), triple(stretch), state.bond_damage[p],
                                    triple(state.bond_slip[p]), false);
}

// Its law bears it now: it is no whole bond.
bool has_law_now(const State& state, const InterfaceLaw& own, int p) {
  return own.law && !is_intact(state.bond_mode[p]);
}

SofteningLaw law_of(const Model& model, const Interface& interface) {
  return softening_law(joint_of(model, interface), interface.kn, interface.ks);
}

JointResponse law_response(const Model& model, const State& state, const InterfaceLaw& own, int p) {
  return joint_response(*own.law, own.spring, model.points[p].normal,
                        local_jump(model, state.displacement, p), state.bond_offset[p],
                        state.joint_history[p]);
}

} // namespace

geom::Vec3 traction(const Model& model, const State& state, int p) {
  const BondPoint& point = model.points[p];
  const Interface& interface = model.interfaces[point.interface];
  if (released(state, interface))
    return geom::Vec3::Zero();
  const geom::Vec3 gap = local_jump(model, state.displacement, p), stretch = gap - state.bond_offset[p];
  const double open = stretch.dot(point.normal);
  if (const InterfaceLaw own = law_of_interface(model, interface); has_law_now(state, own, p))
    return law_response(model, state, own, p).traction;
  if (!is_intact(state.bond_mode[p]))
    return contact_response(interface.kn, interface.ks,
                            geom::portable::tan(model.joints[interface.joint].friction_angle), point.normal,
                            gap, state.bond_offset[p])
        .traction;
  if (damaged(state, p))
    return vec(damaged_response(law_of(model, interface), point, state, p, stretch).traction);
  return interface.kn * open * point.normal + interface.ks * (stretch - open * point.normal);
}

void settle(const Model& model, State& state, int p) {
  const BondPoint& point = model.points[p];
  const Interface& interface = model.interfaces[point.interface];
  if (const InterfaceLaw own = law_of_interface(model, interface); has_law_now(state, own, p)) {
    const JointResponse r = law_response(model, state, own, p);
    state.bond_offset[p] = r.offset;
    state.joint_history[p] = r.history;
    return;
  }
  state.bond_offset[p] =
      contact_response(interface.kn, interface.ks,
                       geom::portable::tan(model.joints[interface.joint].friction_angle), point.normal,
                       local_jump(model, state.displacement, p), state.bond_offset[p])
          .offset;
}

double spring_energy(const Model& model, const State& state, int p) {
  const BondPoint& point = model.points[p];
  const Interface& interface = model.interfaces[point.interface];
  if (const InterfaceLaw own = law_of_interface(model, interface); has_law_now(state, own, p)) {
    if (released(state, interface))
      return 0;
    const JointResponse r = law_response(model, state, own, p);
    return point.area * joint_stored(*own.law, own.spring, point.normal,
                                     local_jump(model, state.displacement, p) - r.offset, r.history.parted);
  }
  if (!damaged(state, p))
    return point.area * stored_in_spring(interface.kn, interface.ks, point.normal, traction(model, state, p));
  const SofteningLaw law = law_of(model, interface);
  const geom::Vec3 stretch = local_jump(model, state.displacement, p) - state.bond_offset[p];
  return point.area * softening_stored<double>(law, triple(point.normal), triple(stretch),
                                               state.bond_damage[p],
                                               damaged_response(law, point, state, p, stretch).contact);
}

double spring_energy(const Model& model, const State& state) {
  double energy = 0;
  for (int p = 0; p < static_cast<int>(model.points.size()); ++p)
    energy += spring_energy(model, state, p);
  return energy;
}

namespace {

// A joint whose strength grows with slip has slipped far enough to bear the shear it begins with, where some slip is enough.
void mobilise(const Model& model, State& state, const InterfaceLaw& own, int p) {
  constexpr double least = 1e-7, most = 1, growth = 1.05; // m
  const geom::Vec3& normal = model.points[p].normal;
  const geom::Vec3 stretch = local_jump(model, state.displacement, p) - state.bond_offset[p];
  const double open = stretch.dot(normal), shear = own.spring.ks * (stretch - open * normal).norm();
  if (open > 0)
    return;
  double& path = state.joint_history[p].path;
  with_law(*own.law, [&](const auto& law) {
    const double pressure = law.pressure(own.spring, -open);
    const auto bears = [&](double x) { return law.strength(own.spring, pressure, x) >= shear; };
    if (bears(path))
      return;
    for (double x = std::max(least, growth * path); x < most; x *= growth)
      if (bears(x)) {
        path = x;
        return;
      }
  });
}

} // namespace

void add_traction(const Model& model, State& state, int p, const geom::Vec3& more) {
  const BondPoint& point = model.points[p];
  const Interface& interface = model.interfaces[point.interface];
  const double normal = more.dot(point.normal);
  double opening = normal / interface.kn;
  if (const InterfaceLaw own = law_of_interface(model, interface); has_law_now(state, own, p)) {
    const double open = (local_jump(model, state.displacement, p) - state.bond_offset[p]).dot(point.normal);
    with_law(*own.law, [&](const auto& law) {
      const double pressure = law.pressure(own.spring, std::max(0.0, -open)) - normal;
      if (pressure > 0) // pulled: as the linear spring, it lets go in the first step
        opening = -law.closure(own.spring, pressure) - open;
    });
  }
  state.bond_offset[p] -= opening * point.normal + (more - normal * point.normal) / interface.ks;
  if (const InterfaceLaw own = law_of_interface(model, interface); has_law_now(state, own, p))
    mobilise(model, state, own, p);
}

} // namespace cdem
