// A contact after the step: its motion, and what follows from it by the contact law.
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/narrow_phase/evaluation.hpp"
#include "libcdem/contact/response/block_motion.hpp"
#include "libcdem/contact/response/contact_point.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

Evaluation::SideMotion Evaluation::motion_of_side(const ContactTriangle& side, const int* nodes,
                                                  const double* weights, int count, double force) const {
  const int block = side.block;
  geom::Vec3 place = geom::Vec3::Zero(), velocity = geom::Vec3::Zero();
  double local = 0; // 1/kg
  // kg, of the corner of the side's own tet: the contacts around a node have the mass of the node together.
  const double density = model_.bodies[model_.blocks[block].body].material.density,
               corner = density * side.area * side.height / 12;
  for (int i = 0; i < count; ++i) {
    place += weights[i] * place_of(model_, state_, nodes[i]);
    velocity += weights[i] * velocity_of(state_, nodes[i]);
    local += weights[i] * weights[i] / moving_mass(model_, state_)[nodes[i]] *
             std::max(1.0, model_.node_mass[nodes[i]] / corner);
  }
  if (work_.travel.last_displacement[block] == 0)
    return {velocity}; // held: it does not turn round
  const Block& b = model_.blocks[block];
  const double mass = b.mass.volume * density;
  SideMotion side_motion{velocity, work_.block_forces[block] / mass, b.rigid >= 0 ? 0 : force * local};
  if (!is_in_one_piece(model_, work_, block))
    side_motion.acceleration += side_motion.local_acceleration;
  else if (work_.knows_motions) {
    const BlockMotion& motion = work_.block_motion[block];
    if (motion.whole)
      side_motion.velocity = motion.velocity + motion.spin.cross(place - motion.centroid);
  }
  return side_motion;
}

void Evaluation::set_approach(const Contact& c, const ContactLaw& law, const ContactArms& arms,
                              const geom::Vec3& velocity, const ContactTriangle& from,
                              const ContactTriangle& to, ContactMotion& motion) const {
  const double force = law.kn * pressed_now(c, motion);
  const SideMotion source = motion_of_side(from, arms.source.data(), arms.on_source.data(), 4, force),
                   target = motion_of_side(to, arms.target.data(), arms.normal.data(), 4, force);
  motion.acceleration = source.acceleration + target.acceleration;
  const double rests = part_at_rest(c), closing = -velocity.dot(motion.normal), // m/s
      approach = (target.velocity - source.velocity).dot(motion.normal);
  const double reversed = reversible_speed(c, motion);
  motion.approach = part_of((1 - rests) * approach + rests * closing, reversed);
  // Bodies that part faster than that are no bodies at rest.
  motion.held_at_most = approach <= -reversed
                            ? 1
                            : part_held(part_damped(c, law), closing, work_.step * motion.acceleration,
                                        work_.step * (source.local_acceleration + target.local_acceleration));
}

void Evaluation::go_on_if_opened(Contact& c) const {
  const std::vector<OpenedContact>& all = state_.opened_contacts;
  const auto opened = std::lower_bound(all.begin(), all.end(), key(c),
                                       [](const auto& a, const auto& b) { return key(a) < b; });
  if (opened == all.end() || key(*opened) != key(c))
    return;
  c.at_rest = opened->last.at_rest;
  c.peak = opened->last.peak;
  c.usual_force = opened->last.usual_force;
  c.felt_force = opened->last.felt_force;
}

void Evaluation::finish(Contact& c, const Contact* old, ContactMotion& motion, const ContactArms& arms,
                        const ContactLaw& law, const ContactTriangle& from, const ContactTriangle& to) {
  const geom::Vec3 velocity = velocity_past(state_, arms);
  motion.slid = work_.step * velocity;
  motion.step = work_.step;
  motion.in_relaxation = !work_.damps;
  ContactForce force;
  const bool own = old && key(*old) == key(c);
  if (own && work_.step == 0 && old->target == c.target) {
    c = *old; // nothing moved
  } else {
    c.normal = old ? old->normal : motion.normal;
    if (old) {
      // Under another stiffness it stores as much.
      const double grows = own && old->stiffness > 0 ? std::sqrt(c.stiffness / old->stiffness) : 1;
      c.shear = grows * old->shear;
      c.damping = grows * old->damping;
      c.at_rest = old->at_rest;
      c.peak = old->peak;
      c.usual_force = old->usual_force;
      c.felt_force = old->felt_force;
    }
    c.depth = own ? old->depth : 0;
    c.reference_penetration =
        own ? next_reference_penetration(*old, motion) : first_reference_penetration(motion);
    if (old && !own)
      force.friction -= take_over(c, *old, law, motion);
    else if (old && old->target != c.target)
      force.friction += target_change_loss(*old, law, motion);
    if (work_.damps && law.damps) {
      motion.omega_step = work_.step * frequency_on_contacts(model_, work_, from.block, to.block);
      motion.shares_friction = shares_friction(model_, work_, from.block, to.block);
      motion.felt_over_usual = felt_over_usual(work_, from.block, to.block);
      if (!old)
        go_on_if_opened(c);
      set_approach(c, law, arms, velocity, from, to, motion);
    }
    const ContactLoss loss = advance(c, law, motion);
    force.friction += loss.friction;
    force.damping = loss.damping;
  }
  force.arms = arms;
  force.source_block = from.block;
  force.target_block = to.block;
  force.normal = normal_force(c, law) * c.normal;
  force.shear = c.shear;
  force.moment = motion.lever * force.normal;
  force.stiffness = law.kn * (1 + part_damped(c, law)) + law.ks;
  out_.contacts.push_back(c);
  out_.forces.push_back(force);
  // Not what was found so deep.
  ContactSums& sums = out_.sums;
  const double pressed = c.effective_penetration(), part = pressed / depth_limit(work_.sizes, from, to);
  sums.depth = std::max(sums.depth, pressed);
  sums.depth_over_height = std::max(sums.depth_over_height, pressed / std::min(from.height, to.height));
  if (part > sums.deepest) {
    sums.deepest = part;
    std::tie(sums.deepest_source, sums.deepest_target) = triangles_of(c);
  }
}

} // namespace cdem
