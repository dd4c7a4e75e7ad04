#include "libcdem/integrate/move_rigid.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/integrate/central_difference.hpp"
#include "libcdem/state/carried_mass.hpp"
#include "libcdem/state/places.hpp"

#include <cmath>

namespace cdem {
namespace {

// mass: kg, of the body and of the water that moves with it; its moments of inertia are those of the body.
void kick(const Model& model, const RigidBody& body, double mass, RigidState& motion, const geom::Vec3& force,
          const geom::Vec3& torque, const Stepping& s, NodeSums& sums) {
  const Elastic& material = model.bodies[model.blocks[body.block].body].material;
  const double viscous = material.viscosity / material.density; // 1/s
  geom::Vec3 l = cdem::vec(motion.angular_momentum);
  if (viscous == 0 && s.local_damping == 0) {
    motion.velocity = three_of(
        central_difference::velocity_after<geom::Vec3>(cdem::vec(motion.velocity), force, mass / s.kick));
    motion.angular_momentum = three_of(l + s.kick * torque); // kept to the last bit without a torque
    return;
  }
  const auto kicked = [&](double before, double pull, double inertia) {
    const auto after = central_difference::velocity_after(before, pull, inertia / s.kick, viscous * inertia,
                                                          s.local_damping);
    sums.damping += after.lost * s.kick;
    return after.velocity;
  };
  for (int axis = 0; axis < 3; ++axis)
    motion.velocity[axis] = kicked(motion.velocity[axis], force[axis], mass);
  // Component by component where they do not mix.
  const geom::Mat3 axes = rotation(motion) * body.axes;
  l = axes.transpose() * l;
  const geom::Vec3 about = axes.transpose() * torque;
  for (int axis = 0; axis < 3; ++axis) {
    const double moment = body.principal[axis];
    l[axis] = moment * kicked(l[axis] / moment, about[axis], moment);
  }
  motion.angular_momentum = three_of(axes * l);
}

} // namespace

RigidForces rigid_forces(const Model& model, const State& state, const ActingForces& acting, int rigid) {
  const Block& block = model.blocks[model.rigid[rigid].block];
  const geom::Vec3 centroid = cdem::vec(state.rigid[rigid].centroid);
  RigidForces forces;
  if (const std::vector<Node>& load = acting.resolved.external; !load.empty())
    for (int i = block.node_begin; i < block.node_end; ++i) {
      const geom::Vec3 f = vec(load[i]);
      forces.load += f;
      forces.load_torque += (model.node_position[i] - centroid + vec(state.displacement[i])).cross(f);
    }
  if (!acting.contact_on_rigid.empty()) {
    forces.contact = acting.contact_on_rigid[rigid].force;
    forces.contact_torque = acting.contact_on_rigid[rigid].torque;
  }
  const bool idle = !acting.idle_blocks.empty() && acting.idle_blocks[model.rigid[rigid].block];
  if (block.convex() && !model.points.empty() && !idle) {
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

geom::Vec3 move_rigid(const Model& model, State& state, const ActingForces& acting, int rigid,
                      const Stepping& s, NodeSums& sums) {
  const RigidBody& body = model.rigid[rigid];
  RigidState& motion = state.rigid[rigid];
  const RigidForces f = rigid_forces(model, state, acting, rigid);
  const geom::Vec3 force = f.load + f.contact, torque = f.load_torque + f.contact_torque;
  const geom::Vec3 velocity_before = cdem::vec(motion.velocity);
  const double ahead = 0.5 * s.time_step;
  const double carried = carried_mass(model, state, model.blocks[body.block]), mass = body.mass + carried;

  geom::Vec3 turning = geom::Vec3::Zero(); // w, half a step ahead
  if (const auto& held = acting.resolved.rigid[rigid]) {
    const double before =
        kinetic_energy(body, motion, s.kick - ahead) + 0.5 * carried * velocity_before.squaredNorm();
    motion.velocity = three_of(*held);
    motion.angular_momentum = {};
    sums.reaction2 += force.squaredNorm();
    // The support gives what the contacts do not, and what the body moves with.
    const double after = 0.5 * mass * held->squaredNorm();
    sums.external += after - before - f.contact.dot((s.kick - ahead) * velocity_before + ahead * *held);
    sums.kinetic += after;
  } else {
    const geom::Vec3 turning_before = spin(body, motion, ahead - s.kick);
    Stepping here = s;
    if (!s.damp_flight && f.contact.isZero(0) && f.contact_torque.isZero(0))
      here.local_damping = 0;
    kick(model, body, mass, motion, force, torque, here, sums);
    turning = spin(body, motion, ahead);
    const geom::Vec3 velocity = cdem::vec(motion.velocity);
    const double arm2 = body.principal[2] / body.mass;
    sums.residual2 += force.squaredNorm() + torque.squaredNorm() / arm2;
    sums.applied2 += f.load.squaredNorm() + f.load_torque.squaredNorm() / arm2;
    sums.external +=
        0.5 * s.kick * (f.load.dot(velocity_before + velocity) + f.load_torque.dot(turning_before + turning));
    sums.kinetic +=
        0.5 * mass * velocity.squaredNorm() + 0.5 * cdem::vec(motion.angular_momentum).dot(turning);
  }

  geom::Vec3 angle = s.time_step * turning;
  motion.centroid = three_of(cdem::vec(motion.centroid) + s.time_step * cdem::vec(motion.velocity));
  turn_by(motion, angle);
  return angle;
}

void place_rigid(const Model& model, State& state, int rigid, const geom::Vec3& angle, double time_step) {
  const Block& block = model.blocks[model.rigid[rigid].block];
  const RigidState& motion = state.rigid[rigid];
  const geom::Vec3 centroid = cdem::vec(motion.centroid), velocity = cdem::vec(motion.velocity);
  const geom::Mat3 now = rotation(motion), chord = turn_less_one(-angle) * now / -time_step;
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
