#include "libcdem/integrate/move_held_nodes.hpp"

#include "libcdem/integrate/central_difference.hpp"
#include "libcdem/integrate/dynamic_relaxation.hpp"
#include "libcdem/state/places.hpp"

#include <utility>

namespace cdem {
namespace {

struct Component {
  double free, prescribed, applied;
};

void step(double force, double mass, const double* viscous, const Stepping& s, const Component& c,
          double& velocity, double& displacement, NodeSums& sums) {
  const double before = velocity;
  if (c.free != 0) {
    sums.residual2 += force * force;
    sums.applied2 += c.applied * c.applied;
    const double inertia = mass * (1 / s.kick);
    if (viscous || s.local_damping != 0) {
      const auto after =
          central_difference::velocity_after(before, force, inertia, viscous ? *viscous : 0, s.local_damping);
      velocity = after.velocity;
      sums.damping += after.lost * s.kick;
    } else {
      velocity = central_difference::velocity_after(before, force, inertia);
    }
    sums.external += c.applied * (0.5 * (before + velocity)) * s.kick;
    sums.kinetic += 0.5 * mass * velocity * velocity;
  } else {
    sums.reaction2 += force * force;
    velocity = c.prescribed;
    const double ahead = 0.5 * s.time_step;
    sums.external += (c.applied - force) * ((s.kick - ahead) * before + ahead * velocity);
    sums.external += 0.5 * mass * (velocity * velocity - before * before); // what holds it changes its motion
  }
  displacement += velocity * s.time_step;
}

void relax(double force, double previous, double mass, const DynamicRelaxation& law, const Component& c,
           double& velocity, double& displacement, NodeSums& sums) {
  const double before = velocity;
  if (c.free != 0) {
    sums.residual2 += force * force;
    sums.applied2 += c.applied * c.applied;
    sums.stiffness -= before * (force - previous);
    sums.inertia += mass * before * before;
    velocity = law.velocity_after(before, force, mass);
    const double mean = 0.5 * (before + velocity);
    sums.external += c.applied * mean;
    sums.damping += law.lost(mean, mass);
    sums.kinetic += 0.5 * mass * velocity * velocity;
  } else {
    sums.reaction2 += force * force;
    velocity = c.prescribed;
    // The support gives what the body's own forces do not: work of loads and reaction together.
    sums.external += (c.applied - force) * 0.5 * (before + velocity);
  }
  displacement += velocity;
}

} // namespace

void step_held_node(const MovingNodes& node, const HeldNode& h, const Stepping& s, NodeSums& sums) {
  const auto [f, load] = held_node_forces(node);
  const double m = *node.mass;
  Node &v = *node.velocity, &u = *node.displacement;
  step(f.x, m, node.viscous, s, {h.free.x, h.prescribed.x, load.x}, v.x, u.x, sums);
  step(f.y, m, node.viscous, s, {h.free.y, h.prescribed.y, load.y}, v.y, u.y, sums);
  step(f.z, m, node.viscous, s, {h.free.z, h.prescribed.z, load.z}, v.z, u.z, sums);
}

void step_dashpot_node(const MovingNodes& node, const HeldNode& h, const geom::Mat3& dashpot,
                       const Stepping& s, NodeSums& sums) {
  const auto [net, applied] = held_node_forces(node);
  const geom::Vec3 force = vec(net), load = vec(applied), before = vec(*node.velocity),
                   prescribed = vec(h.prescribed);
  const std::array<bool, 3> free{h.free.x != 0, h.free.y != 0, h.free.z != 0};
  const double inertia = *node.mass / s.kick, viscous = node.viscous ? *node.viscous : 0;
  const geom::Mat3 half = 0.5 * (dashpot + viscous * geom::Mat3::Identity());
  geom::Mat3 matrix = inertia * geom::Mat3::Identity() + half;
  geom::Vec3 right = inertia * before - half * before + force;
  for (int axis = 0; axis < 3; ++axis)
    if (!free[axis]) {
      matrix.row(axis) = geom::Vec3::Unit(axis).transpose();
      right[axis] = prescribed[axis];
    }
  const geom::Vec3 now = matrix.inverse() * right, mean = 0.5 * (before + now), pull = dashpot * mean;
  const double ahead = 0.5 * s.time_step;
  for (int axis = 0; axis < 3; ++axis) {
    const double out_of_balance = force[axis] - pull[axis];
    sums.radiated += s.kick * pull[axis] * mean[axis];
    if (free[axis]) {
      sums.residual2 += out_of_balance * out_of_balance;
      sums.applied2 += load[axis] * load[axis];
      sums.damping += s.kick * viscous * mean[axis] * mean[axis];
      sums.external += s.kick * load[axis] * mean[axis];
      sums.kinetic += 0.5 * *node.mass * now[axis] * now[axis];
    } else { // the support does what neither the body nor the dashpot does
      sums.reaction2 += out_of_balance * out_of_balance;
      sums.external += (load[axis] - force[axis]) * ((s.kick - ahead) * before[axis] + ahead * now[axis]) +
                       s.kick * pull[axis] * mean[axis] +
                       0.5 * *node.mass * (now[axis] * now[axis] - before[axis] * before[axis]);
    }
  }
  *node.velocity = cdem::node(now);
  *node.displacement = cdem::node(vec(*node.displacement) + s.time_step * now);
}

void relax_held_node(const MovingNodes& node, const HeldNode& h, double damping, Node& previous_force,
                     NodeSums& sums) {
  const auto [f, load] = held_node_forces(node);
  const Node old = std::exchange(previous_force, f);
  const DynamicRelaxation law(damping);
  const double m = *node.mass;
  Node &v = *node.velocity, &u = *node.displacement;
  relax(f.x, old.x, m, law, {h.free.x, h.prescribed.x, load.x}, v.x, u.x, sums);
  relax(f.y, old.y, m, law, {h.free.y, h.prescribed.y, load.y}, v.y, u.y, sums);
  relax(f.z, old.z, m, law, {h.free.z, h.prescribed.z, load.z}, v.z, u.z, sums);
}

} // namespace cdem
