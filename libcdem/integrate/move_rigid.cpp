#include "libcdem/integrate/move_rigid.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/state/places.hpp"

#include <cmath>

namespace cdem {
namespace {

// One component of m dv/dt = F - c m v - alpha |F| sign(v): the law of step_nodes. Returns the velocity after.
double damped(double before, double force, double mass, double viscous_rate, const Stepping& s,
              double& lost) {
  const double inertia = mass / s.kick, half = 0.5 * viscous_rate * mass, heavy = inertia + half;
  const double undamped = ((inertia - half) * before + force) / heavy;
  const double most = s.local_damping * std::abs(force) / heavy, both = before + undamped;
  const double velocity = both > most ? undamped - most : both < -most ? undamped + most : -before;
  const double mean = 0.5 * (before + velocity);
  lost += (2 * half * mean + heavy * (undamped - velocity)) * mean * s.kick;
  return velocity;
}

void kick(const Model& model, const RigidBody& body, RigidState& motion, const geom::Vec3& force,
          const geom::Vec3& torque, const Stepping& s, NodeSums& sums) {
  const Elastic& material = model.bodies[model.blocks[body.block].body].material;
  const double viscous = material.viscosity / material.density;
  geom::Vec3 l = cdem::vec(motion.angular_momentum);
  if (viscous == 0 && s.local_damping == 0) {
    motion.velocity = triple(cdem::vec(motion.velocity) + s.kick / body.mass * force);
    motion.angular_momentum = triple(l + s.kick * torque);
    return;
  }
  for (int axis = 0; axis < 3; ++axis)
    motion.velocity[axis] = damped(motion.velocity[axis], force[axis], body.mass, viscous, s, sums.damping);
  // Component by component where they do not mix.
  const geom::Mat3 axes = rotation(motion) * body.axes;
  l = axes.transpose() * l;
  const geom::Vec3 about = axes.transpose() * torque;
  for (int axis = 0; axis < 3; ++axis) {
    const double moment = body.principal[axis];
    l[axis] = moment * damped(l[axis] / moment, about[axis], moment, viscous, s, sums.damping);
  }
  motion.angular_momentum = triple(axes * l);
}

} // namespace

RigidForces rigid_forces(const Model& model, const State& state, const ActingForces& acting, int rigid) {
  const Block& block = model.blocks[model.rigid[rigid].block];
  const geom::Vec3 centroid = cdem::vec(state.rigid[rigid].centroid);
  RigidForces forces;
  const auto sum = [&](const std::vector<Node>& nodes, geom::Vec3& force, geom::Vec3& torque) {
    if (nodes.empty())
      return;
    for (int i = block.node_begin; i < block.node_end; ++i) {
      const geom::Vec3 f = vec(nodes[i]);
      force += f;
      torque += (model.node_position[i] - centroid + vec(state.displacement[i])).cross(f);
    }
  };
  sum(acting.resolved.external, forces.load, forces.load_torque);
  sum(acting.contact, forces.contact, forces.contact_torque);
  if (block.convex() && !model.points.empty()) {
    const std::vector<geom::Vec3>& bonds = acting.bond;
    for (int i = block.node_begin; i < block.node_end; ++i) {
      Node f;
      add_bond_forces(model, bonds, {i, i + 1}, &f);
      forces.contact += vec(f);
      forces.contact_torque += (model.node_position[i] - centroid + vec(state.displacement[i])).cross(vec(f));
    }
  }
  return forces;
}

void move_rigid(const Model& model, State& state, const ActingForces& acting, int rigid, const Stepping& s,
                NodeSums& sums) {
  const RigidBody& body = model.rigid[rigid];
  const Block& block = model.blocks[body.block];
  RigidState& motion = state.rigid[rigid];
  const RigidForces f = rigid_forces(model, state, acting, rigid);
  const geom::Vec3 force = f.load + f.contact, torque = f.load_torque + f.contact_torque;
  const geom::Vec3 velocity_before = cdem::vec(motion.velocity);
  const double ahead = 0.5 * s.time_step;

  geom::Vec3 turning = geom::Vec3::Zero(); // w, half a step ahead
  if (const auto& held = acting.resolved.rigid[rigid]) {
    const double before = kinetic_energy(body, motion, s.kick - ahead);
    motion.velocity = triple(*held);
    motion.angular_momentum = {};
    sums.reaction2 += force.squaredNorm();
    // The support gives what the contacts do not, and what the body moves with.
    const double after = 0.5 * body.mass * held->squaredNorm();
    sums.external += after - before - f.contact.dot((s.kick - ahead) * velocity_before + ahead * *held);
    sums.kinetic += after;
  } else {
    const geom::Vec3 turning_before = spin(body, motion, ahead - s.kick);
    Stepping here = s;
    if (!s.damp_flight && f.contact.isZero(0) && f.contact_torque.isZero(0))
      here.local_damping = 0;
    kick(model, body, motion, force, torque, here, sums);
    turning = spin(body, motion, ahead);
    const geom::Vec3 velocity = cdem::vec(motion.velocity);
    const double arm2 = body.principal[2] / body.mass;
    sums.residual2 += force.squaredNorm() + torque.squaredNorm() / arm2;
    sums.applied2 += f.load.squaredNorm() + f.load_torque.squaredNorm() / arm2;
    sums.external +=
        0.5 * s.kick * (f.load.dot(velocity_before + velocity) + f.load_torque.dot(turning_before + turning));
    sums.kinetic +=
        0.5 * body.mass * velocity.squaredNorm() + 0.5 * cdem::vec(motion.angular_momentum).dot(turning);
  }

  const geom::Vec3 velocity = cdem::vec(motion.velocity), angle = s.time_step * turning;
  const geom::Mat3 chord = turn_less_one(angle) * rotation(motion) / s.time_step;
  motion.centroid = triple(cdem::vec(motion.centroid) + s.time_step * velocity);
  turn_by(motion, angle);
  const geom::Vec3 centroid = cdem::vec(motion.centroid);
  const geom::Mat3 now = rotation(motion);
  for (int i = block.node_begin; i < block.node_end; ++i) {
    const geom::Vec3 offset = vec(state.rigid_offset[i]);
    state.velocity[i] = node(velocity + chord * offset);
    state.displacement[i] = node(centroid + now * offset - model.node_position[i]);
  }
}

void hold_rigid(const Model& model, const State& state, const ActingForces& acting, int rigid,
                NodeSums& sums) {
  const RigidForces f = rigid_forces(model, state, acting, rigid);
  sums.reaction2 += (f.load + f.contact).squaredNorm();
}

} // namespace cdem
