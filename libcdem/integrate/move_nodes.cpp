#include "libcdem/integrate/move_nodes.hpp"

#include "libcdem/integrate/central_difference.hpp"
#include "libcdem/integrate/dynamic_relaxation.hpp"
#include "libcdem/parallel/simd.hpp"

namespace cdem {
namespace {

using simd::Quad;

CDEM_INLINE double sum(const Quad& q) {
  return q[0] + q[1] + q[2];
}

CDEM_INLINE Quad all(double value) {
  return Quad{} + value;
}

CDEM_INLINE Quad load_or_zero(const Node* nodes, std::int64_t i) {
  return nodes ? simd::load(nodes[i]) : Quad{};
}

CDEM_INLINE void step_kernel(const MovingNodes& moving, const Stepping& stepping, NodeSums& sums) {
  const MovingNodes nodes = moving; // copies: what is written cannot change them
  const Stepping s = stepping;
  Quad residual2{}, applied2{}, external{}, lost{}, kinetic{};
  const double per_kick = 1 / s.kick;
  const bool damped = nodes.viscous || s.local_damping != 0;
  for (std::int64_t i = 0; i < nodes.count; ++i) {
    const Quad load = load_or_zero(nodes.external, i);
    const Quad force =
        simd::load(nodes.force[i]) + load_or_zero(nodes.internal, i) + load_or_zero(nodes.contact, i) + load;
    const Quad before = simd::load(nodes.velocity[i]);
    const double mass = nodes.mass[i], inertia = mass * per_kick;
    Quad velocity;
    if (damped) {
      const auto after = central_difference::velocity_after(
          before, force, inertia, nodes.viscous ? nodes.viscous[i] : 0, s.local_damping);
      velocity = after.velocity;
      lost += after.lost;
    } else {
      velocity = central_difference::velocity_after(before, force, inertia);
    }
    residual2 += force * force;
    applied2 += load * load;
    external += load * (0.5 * (before + velocity));
    kinetic += 0.5 * mass * velocity * velocity;
    simd::store(nodes.velocity[i], velocity);
    simd::store(nodes.displacement[i], simd::load(nodes.displacement[i]) + velocity * all(s.time_step));
  }
  sums.residual2 += sum(residual2);
  sums.applied2 += sum(applied2);
  sums.external += sum(external) * s.kick;
  sums.damping += sum(lost) * s.kick;
  sums.kinetic += sum(kinetic);
}

CDEM_INLINE void relax_kernel(const MovingNodes& moving, double damping, Node* previous_force,
                              NodeSums& sums) {
  const MovingNodes nodes = moving;
  Quad residual2{}, applied2{}, stiffness{}, inertia{}, external{}, lost{}, kinetic{};
  const DynamicRelaxation law(damping);
  for (std::int64_t i = 0; i < nodes.count; ++i) {
    const Quad load = load_or_zero(nodes.external, i);
    const Quad force =
        simd::load(nodes.force[i]) + load_or_zero(nodes.internal, i) + load_or_zero(nodes.contact, i) + load;
    const Quad before = simd::load(nodes.velocity[i]);
    const double mass = nodes.mass[i];
    const Quad velocity = law.velocity_after(before, force, mass);
    const Quad mean = 0.5 * (before + velocity);
    residual2 += force * force;
    applied2 += load * load;
    stiffness -= before * (force - simd::load(previous_force[i]));
    inertia += mass * before * before;
    external += load * mean;
    lost += law.lost(mean, mass);
    kinetic += 0.5 * mass * velocity * velocity;
    simd::store(previous_force[i], force);
    simd::store(nodes.velocity[i], velocity);
    simd::store(nodes.displacement[i], simd::load(nodes.displacement[i]) + velocity);
  }
  sums.residual2 += sum(residual2);
  sums.applied2 += sum(applied2);
  sums.stiffness += sum(stiffness);
  sums.inertia += sum(inertia);
  sums.external += sum(external);
  sums.damping += sum(lost);
  sums.kinetic += sum(kinetic);
}

} // namespace

MovingNodes moving_nodes(State& state, const ActingForces& acting, const std::vector<double>& mass,
                         Range range, const Node* force) {
  const ResolvedConditions& r = acting.resolved;
  const std::int64_t first = range.begin;
  MovingNodes nodes;
  nodes.force = force;
  nodes.internal = r.internal.empty() ? nullptr : r.internal.data() + first;
  nodes.external = r.external.empty() ? nullptr : r.external.data() + first;
  nodes.contact = acting.contact.empty() ? nullptr : acting.contact.data() + first;
  nodes.mass = mass.data() + first;
  nodes.velocity = state.velocity.data() + first;
  nodes.displacement = state.displacement.data() + first;
  nodes.count = range.size();
  return nodes;
}

HeldForces held_node_forces(const MovingNodes& node) {
  HeldForces forces;
  const Quad load = load_or_zero(node.external, 0);
  simd::store(forces.load, load);
  simd::store(forces.net, simd::load(*node.force) + load_or_zero(node.internal, 0) +
                              load_or_zero(node.contact, 0) + load);
  return forces;
}

void step_nodes(const MovingNodes& nodes, const Stepping& stepping, NodeSums& sums) {
  simd::best<step_kernel>(nodes, stepping, sums);
}

void relax_nodes(const MovingNodes& nodes, double damping, Node* previous_force, NodeSums& sums) {
  simd::best<relax_kernel>(nodes, damping, previous_force, sums);
}

} // namespace cdem
