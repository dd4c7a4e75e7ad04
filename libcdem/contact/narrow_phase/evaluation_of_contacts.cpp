// A contact after the step: its motion, and what follows from it by the contact law.
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/data/row_owner.hpp"
#include "libcdem/contact/narrow_phase/evaluation.hpp"
#include "libcdem/contact/response/block_motion.hpp"
#include "libcdem/contact/response/contact_point.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

Evaluation::BlockSide Evaluation::side_of(int block) const {
  const Block& b = model_.blocks[block];
  BlockSide side;
  side.turns_round = work_.travel.last_displacement[block] != 0;
  side.deforms = b.rigid < 0;
  side.in_one_piece = is_in_one_piece(model_, work_, block);
  side.density = model_.bodies[b.body].material.density;
  if (!side.turns_round)
    return side;
  side.acceleration = work_.block_forces[block] / (b.mass.volume * side.density);
  if (side.in_one_piece && work_.knows_motions && work_.block_motion[block].whole)
    side.motion = &work_.block_motion[block];
  return side;
}

const Evaluation::BlockPair& Evaluation::pair_of(int source_block, int target_block) {
  BlockPair& pair = pairs_[static_cast<std::size_t>(source_block + target_block) % pairs_.size()];
  if (pair.source_block != source_block || pair.target_block != target_block)
    pair = {source_block,
            target_block,
            side_of(source_block),
            side_of(target_block),
            work_.step * frequency_on_contacts(model_, work_, source_block, target_block),
            felt_over_usual(work_, source_block, target_block),
            shares_friction(model_, work_, source_block, target_block)};
  return pair;
}

geom::Vec3 Evaluation::velocity_of_side(const BlockSide& side, const std::array<int, 4>& nodes,
                                        const std::array<double, 4>& weights) const {
  geom::Vec3 sum = geom::Vec3::Zero(); // m/s, or m
  for (int i = 0; i < 4; ++i)
    if (weights[i] != 0)
      sum += weights[i] * (side.motion ? place_of(model_, state_, nodes[i]) : velocity_of(state_, nodes[i]));
  return side.motion ? side.motion->velocity + side.motion->spin.cross(sum - side.motion->centroid) : sum;
}

double Evaluation::local_acceleration(const BlockSide& side, const ContactTriangle& triangle,
                                      const std::array<int, 4>& nodes, const std::array<double, 4>& weights,
                                      double force) const {
  if (!side.turns_round || !side.deforms)
    return 0;
  // kg, of the corner of the side's own tet: the contacts around a node have the mass of the node together.
  const double corner = side.density * triangle.area * triangle.height / 12;
  const std::vector<double>& mass = moving_mass(model_, state_);
  double sum = 0; // 1/kg
  for (int i = 0; i < 4; ++i)
    if (weights[i] != 0)
      sum += weights[i] * weights[i] / mass[nodes[i]] * std::max(1.0, model_.node_mass[nodes[i]] / corner);
  return force * sum;
}

void Evaluation::set_approach(const Contact& c, const ContactLaw& law, const BlockPair& pair,
                              const ContactArms& arms, const geom::Vec3& velocity,
                              const ContactTriangle& from, const ContactTriangle& to,
                              ContactMotion& motion) const {
  const double force = law.kn * pressed_now(c, motion);
  const auto of_source = [&] {
    return local_acceleration(pair.source, from, arms.source, arms.on_source, force);
  };
  const auto of_target = [&] { return local_acceleration(pair.target, to, arms.target, arms.normal, force); };
  motion.acceleration = pair.source.acceleration + (pair.source.in_one_piece ? 0 : of_source()) +
                        (pair.target.acceleration + (pair.target.in_one_piece ? 0 : of_target()));
  const double rests = part_at_rest(c), closing = -velocity.dot(motion.normal), // m/s
      approach = (velocity_of_side(pair.target, arms.target, arms.normal) -
                  velocity_of_side(pair.source, arms.source, arms.on_source))
                     .dot(motion.normal);
  const double reversed = reversible_speed(c, motion, rests);
  motion.approach = part_of((1 - rests) * approach + rests * closing, reversed);
  if (motion.approach >= 0)
    return; // nothing is held
  // Bodies that part faster than that are no bodies at rest. Nodes part as fast when they vibrate, and their speed counts as that of
  // bodies only where restitution asks for it.
  const bool tells = law.damping_ratio > 0 || (pair.source.moves_as_whole() && pair.target.moves_as_whole());
  motion.held_at_most = tells && approach <= -reversed
                            ? 1
                            : part_held(part_damped(law, rests), closing, work_.step * motion.acceleration,
                                        work_.step * (of_source() + of_target()),
                                        tells ? most_of_speed : most_where_nothing_tells_a_hop);
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

// The area of a flat face follows the slip: it grows by the mean widening before and after the step. So the force along the slip,
// at most the normal force, does as much work as the area stores less.
void Evaluation::widen(Contact& c, const Contact& old, const ContactMotion& motion, const OnFace& on) const {
  const bool widened = old.from_end == 1 && !old.widening.isZero(0);
  if (on.nearing == 0 && !widened)
    return;
  const geom::Vec3 slid = motion.slid - motion.slid.dot(motion.normal) * motion.normal;
  if (widened)
    c.widening = turned_with(old.widening, old.normal, motion.normal);
  const double half_way = old.area + 0.5 * c.widening.dot(slid), square = slid.squaredNorm();
  if (on.nearing > 0)
    c.widening = (on.area > 0 && square > 0 ? on.nearing * (on.area - half_way) / square : 0) * slid;
  const double widest = c.widening.norm() * old.effective_penetration(), most = 2 * old.area;
  if (widest > most)
    c.widening *= most / widest;
  c.area = std::max(0.1 * old.area, half_way + 0.5 * c.widening.dot(slid));
  c.stiffness *= c.area / old.area;
}

// A crossing near an end of one of its edges: its energy follows from where it is and how deep, so it needs no history.
void Evaluation::pass_end(Contact& c, const Contact* old, const ContactLaw& usual,
                          const ContactMotion& motion, const OnFace& on) {
  constexpr double least = 0.03; // nothing is left there
  const double before = old ? next_reference_penetration(*old, motion) : first_reference_penetration(motion),
               reach = reach_of_end * (motion.depth - before), whole = part_near_end(old ? old->from_end : 1);
  c.from_end = on.to_end < reach ? std::max(least, on.to_end / reach) : 1;
  c.stiffness = part_near_end(c.from_end) / whole * (c.stiffness > 0 ? c.stiffness : usual.kn);
  c.widening = geom::Vec3::Zero();
  if (c.from_end < 1 && c.from_end > least)
    c.widening = slope_near_end(c.from_end) / reach * on.off_end;
}

void Evaluation::finish(Contact& c, const Contact* old, ContactMotion& motion, const ContactArms& arms,
                        const ContactLaw& usual, const ContactTriangle& from, const ContactTriangle& to,
                        const OnFace& on) {
  const geom::Vec3 velocity = velocity_past(state_, arms);
  motion.slid = work_.step * velocity;
  motion.step = work_.step;
  motion.in_relaxation = !work_.damps;
  ContactForce force;
  const bool own = old && key(*old) == key(c),
             on_face = own && (old->area > 0 || on.crosses) && !motion.along_stretch;
  if (on.crosses && (own || !old))
    pass_end(c, old, usual, motion, on);
  else if (on_face)
    widen(c, *old, motion, on);
  const ContactLaw law = as_stiff_as(c, usual);
  const auto set_part_of_step = [&](double pressed) {
    if (both_rigid(model_, from.block, to.block))
      motion.part_of_step = part_of_step(
          pressed, 2 * state_.velocity_lag * (velocity.dot(motion.normal) + motion.lever * motion.spin_past));
  };
  if (own && work_.step == 0 && old->target == c.target) {
    c = *old; // nothing moved
    set_part_of_step(c.effective_penetration());
  } else {
    // Under another stiffness it stores as much, but what presses on a flat face keeps its depth.
    const double grows = own && old->stiffness > 0 ? std::sqrt(c.stiffness / old->stiffness) : 1;
    c.normal = old ? old->normal : motion.normal;
    if (old) {
      c.shear = grows * old->shear;
      c.damping = grows * old->damping;
      c.at_rest = old->at_rest;
      c.peak = old->peak;
      c.usual_force = old->usual_force;
      c.felt_force = old->felt_force;
    }
    c.depth = own ? old->depth : 0;
    c.reference_penetration = own          ? next_reference_penetration(*old, motion)
                              : on.slid_on ? 0
                                           : first_reference_penetration(motion);
    if (motion.along_stretch)
      c.reference_penetration /= grows;
    else if (grows != 1 && !on_face) // a crossing that has turned into a stretch
      c.reference_penetration =
          motion.depth - std::max(0.0, old->effective_penetration() / grows - motion.opened());
    if (old && !own)
      force.friction -= take_over(c, *old, law, motion);
    else if (old && old->target != c.target)
      force.friction += target_change_loss(*old, law, motion);
    if (work_.damps && law.damps) {
      const BlockPair& pair = pair_of(from.block, to.block);
      motion.omega_step = pair.omega_step;
      motion.shares_friction = pair.shares_friction;
      motion.felt_over_usual = pair.felt_over_usual;
      if (!old)
        go_on_if_opened(c);
      set_approach(c, law, pair, arms, velocity, from, to, motion);
    }
    set_part_of_step(pressed_now(c, motion));
    const ContactLoss loss = advance(c, law, motion);
    force.friction += loss.friction;
    force.damping = loss.damping;
    if (!old && on.slid_on)
      force.friction -= 0.5 * law.kn * c.effective_penetration() * c.effective_penetration();
  }
  force.arms = arms;
  force.source_block = from.block;
  force.target_block = to.block;
  force.normal = part_borne(motion) * normal_force(c, law) * c.normal;
  const geom::Vec3 along = along_face(c, law);
  force.moment = motion.lever * force.normal + along.norm() * motion.end_moment;
  force.stiffness = (law.kn * (1 + part_damped(c, law)) + std::max(law.ks, most_stiff_near_end(c) * law.kn)) /
                    part_near_end(c.from_end);
  force.shear = c.shear + along;
  out_.contacts.push_back(c);
  out_.forces.push_back(force);
  // Not what was found so deep.
  ContactSums& sums = out_.sums;
  const double pressed = c.effective_penetration() * force_near_end(c.from_end),
               part = pressed / depth_limit(work_.sizes, from, to);
  sums.depth = std::max(sums.depth, pressed);
  sums.depth_over_height = std::max(sums.depth_over_height, pressed / std::min(from.height, to.height));
  if (part > sums.deepest) {
    sums.deepest = part;
    std::tie(sums.deepest_source, sums.deepest_target) = triangles_of(c);
  }
}

} // namespace cdem
