// Law of one contact (Feng 2014 eqs 15-18 with T = C = 0): pure functions.
//
//   Fn = kn (d - d0)+            d depth below the target's surface; d0 = 0, or the depth at which it was found
//   Fs = R Fs - ks du_s          R turns it with the normal, and about it with the two faces; du_s slip of this step
//   |Fs| <= N tan(phi)          N the normal force; of deformable bodies the contact's usual share, see below
//
// With a coefficient of restitution e < 1 the contact returns the fraction e^2 of the energy 1/2 k d^2 that goes into it,
// k = 2 kn / (1 + e^2). At rest it damps what vibrates, also with e = 1. Beside the spring kn acts a force D, with
// r = (1 - e^2) / (1 + e^2) and b = r + (1 - r) w:
//
//   bodies approach:  D = b kn q,          q <- q + closing of this step, 0 <= q <= s p
//   they separate:    D = -b kn p |s|,     only while the contact itself opens; q = 0
//
// p is the effective penetration, s = v / v0 within -1 and 1. While the bodies approach D is a spring that stores
// 1/2 b kn q^2. Damping is what it loses when its bound s p falls, and the work of D while the contact opens. So damping
// gives no energy back, whatever the waves in the bodies do, but for the half step after the contact turns round.
//
//   v  = (1 - w) v_bodies + w v_contact,  v0 = max(a dt, w sqrt(a p))
//   w = u^8,  u = min(1, 2 p_rest / p_peak),  d p_rest / dt = (p - p_rest) omega / 10
//   omega^2: sum over both bodies of K / m
//
// v_bodies: speed at which the bodies approach, each moving as a whole; v_contact: at which the contact closes; a: sum of
// the normal forces on each body over its mass; K: sum of kn of the contacts that press a body, m its mass. sqrt(p / a) and
// 1 / omega are time scales of an oscillation. p_peak is the largest p, and fades as p_rest follows p. In an impact w is next
// to nothing, and D is there, with b = r, down to the speed that the forces of one step reverse. A contact that carries
// for long has w = 1, and v0 is the speed that its forces reverse within its depth: what is slower vibrates about its rest,
// and D is at most in proportion to v, as that of a dashpot with half of the critical damping. If D jumped with each
// change of direction, so would the limit of friction, and a body would creep down a slope far below its friction. A contact
// that opens for less than 8 / omega goes on with all its means, so low hops of a body die too.
//
// Where both bodies are rigid, and between tetrahedra of one body, b is r and D is 0 for e = 1.
//
// A contact of rigid bodies bears (1 + t) / 2 of Fn + D, with t = p / |u| up to 1 and u its motion along the normal in the last
// step: t is less than 1 only where it has closed within that step, or is about to open within the next. Its force acts over
// half of either step, so its work there is kn p |u| (1 + t) / 2 = kn p^2 / 2 + kn p |u| / 2: what the spring stores, and the
// half step in which it is pressed throughout.
//
// A sliding contact does not feel a change of its normal force at once (Prakash 1998, J. Tribol. 120, 97-102; Cochard and
// Rice 2000, J. Geophys. Res. 105, 25891-25907). If it did, friction would feed the vibrations of a deformable body that
// slides, and they would take a part of its friction (Adams 1998, J. Appl. Mech. 65, 470-475). So where a body deforms and neither is broken,
// friction follows a usual share of what the bodies press with, by two means M and P of F = Fn + D:
//
//   N = (1 - w) F + w M (sum of w P) / (sum of w M)
//   dM / dt = (F - M) omega / 60,   dP / dt = (F - P) omega / 4
//
// The sums go over the contacts between the two bodies before the step. So each contact has its mean share, and all together have
// the friction of the whole normal force of two thirds of an oscillation before: on a ground that shakes, or when a load comes on at once.
// In an impact, and as long as a body bounces higher than it rests, w is next to nothing, and N is F. After a longer opening M and P
// begin with 0.
//
// An overlap that exists before anything has moved (d0 > 0) carries no force: with the stiffness of concrete a tenth of
// a millimetre would throw a unit into the air.
#pragma once

#include "libcdem/joint/coulomb_friction.hpp"
#include "libcdem/state/contact.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

struct ContactLaw {
  double kn = 0, ks = 0; // N/m, of the springs
  double tan_friction = 0;
  double damping_ratio = 0; // r = (1 - e^2) / (1 + e^2)
  bool damps = false;       // else D is 0
  bool damps_more_at_rest = false;
};

// A semi-spring keeps the stiffness with which it began to press, or with which it took over the force of a face, and any
// contact of a body that was turned rigid or deformable that which it had.
inline ContactLaw as_stiff_as(const Contact& c, ContactLaw law) {
  if (c.stiffness > 0) {
    law.ks *= c.stiffness / law.kn;
    law.kn = c.stiffness;
  }
  return law;
}

// What has happened to a contact since it was last looked at.
struct ContactMotion {
  geom::Vec3 normal = geom::Vec3::Zero(); // unit, out of the target, now
  double depth = 0;                       // m, now
  geom::Vec3 slid = geom::Vec3::Zero();   // m, of the source past the target
  double turned = 0;                      // rad, of the two faces about the normal
  double spin_past = 0;                   // rad/s, of the source past the target about the normal
  double lever = 0;                       // m, of a moment about the normal, over the normal force beside it
  geom::Vec3 end_moment = geom::Vec3::Zero(); // m, the moment beside a force off an end, over that force
  bool along_stretch = false;                 // part of a stretch that carries, which may grow in a jump
  double step = 0;                            // s, in which that happened
  double approach = 0;                        // s of restitution: 1 the bodies approach, -1 they separate
  double acceleration = 0;                    // m/s2, a of restitution
  double held_at_most = 0;                    // part of the damping force that may act, part_held
  double omega_step = 0;                      // omega times the step
  double part_of_step = 1;                    // t above
  bool shares_friction = false;               // one of its two bodies deforms, and neither is broken
  double felt_over_usual = 1;                 // these two means, summed over the contacts between its bodies
  bool in_relaxation = false;                 // its steps are no times, and it finds the contact at rest

  double opened() const { return slid.dot(normal) + lever * step * spin_past; } // m
};

// What a contact loses in a step, J, >= 0.
struct ContactLoss {
  double friction = 0, damping = 0;
};

// A vector at right angles to the unit vector `from`, rotated by the smallest rotation from `from` to `to`.
inline geom::Vec3 turned_with(const geom::Vec3& v, const geom::Vec3& from, const geom::Vec3& to) {
  const double c = from.dot(to);
  if (c < -0.5) // not a motion but another face
    return v - v.dot(to) * to;
  return v - v.dot(to) / (1 + c) * (from + to);
}

// Where a contact that is new starts to carry: at the surface when it got this deep within the step.
inline double first_reference_penetration(const ContactMotion& m) {
  return m.along_stretch || m.depth <= -1.5 * m.slid.dot(m.normal) ? 0 : m.depth;
}

// The reference of a contact that goes on. If its normal turns over to another face within a step, its depth may grow by more than
// 1.5 times the relative motion. The reference then grows by the same jump, so the force is continuous.
inline double next_reference_penetration(const Contact& old, const ContactMotion& m) {
  const double before = m.depth + m.slid.dot(m.normal), // m, before the step under the normal of now
      jump = before - old.reference_penetration - old.effective_penetration();
  return old.reference_penetration + (!m.along_stretch && jump > 1.5 * m.slid.norm() ? jump : 0);
}

// speed / reversed, within -1 and 1.
inline double part_of(double speed, double reversed) {
  return std::abs(speed) < reversed ? speed / reversed : std::copysign(1.0, speed);
}

// Times over 1 / omega: of the means p_rest, M and P, and of openings through which all means go on.
constexpr double time_of_rest = 10, time_of_share = 60, time_of_feeling = 4, time_of_opening = 8;

// m, of a contact before it advances: its effective penetration after the step.
inline double pressed_now(const Contact& c, const ContactMotion& m) {
  return std::max(0.0, m.depth - c.reference_penetration);
}

// w: 1 where a contact carries for long, next to nothing in an impact, 0 where it has just begun.
inline double part_at_rest(const Contact& c) {
  const double u = std::min(c.peak, 2 * c.at_rest) / c.peak, u2 = u * u, u4 = u2 * u2;
  return c.peak > 0 ? u4 * u4 : 0;
}

// b of restitution.
inline double part_damped(const ContactLaw& law, double rests) {
  return law.damps_more_at_rest ? law.damping_ratio + (1 - law.damping_ratio) * rests : law.damping_ratio;
}
inline double part_damped(const Contact& c, const ContactLaw& law) {
  return part_damped(law, law.damps_more_at_rest ? part_at_rest(c) : 0);
}

// q, m: how far the contact has been pressed while its bodies approached. part: part_damped.
inline double pressed_by_approach(const Contact& c, const ContactLaw& law, double part) {
  return c.damping > 0 && part > 0 ? c.damping / (part * law.kn) : 0;
}
// J, stored in the force of restitution.
inline double stored_by_damping(const Contact& c, double pressed_by_approach) {
  return 0.5 * std::max(0.0, c.damping) * pressed_by_approach;
}
inline double stored_by_damping(const Contact& c, const ContactLaw& law) {
  return c.damping > 0 ? stored_by_damping(c, pressed_by_approach(c, law, part_damped(c, law))) : 0;
}

// Part of the damping force, up to 1, that turns nothing round. It takes no more than `most` of the speed of the nodes at the
// contact in a step: the velocity that it follows is half a step old, and central differences are stable as long as the part is
// below 2 - 2 safety^2, 0.38 at the default safety. In a step, normal forces change the speed of the bodies by by_bodies, and this
// contact that of its nodes by by_nodes, m/s.
constexpr double most_of_speed = 0.15, most_where_nothing_tells_a_hop = 0.35;
inline double part_held(double damped, double speed, double by_bodies, double by_nodes,
                        double most = most_of_speed) {
  return std::abs(part_of(speed, 0.5 * by_bodies + damped / most * by_nodes));
}

// m/s, v0 of restitution, of a contact before it advances.
inline double reversible_speed(const Contact& c, const ContactMotion& m, double rests) {
  return std::max(m.step * m.acceleration, rests * std::sqrt(m.acceleration * pressed_now(c, m)));
}

// Advances the means of restitution.
inline void advance_rest(Contact& c, const ContactMotion& m) {
  const double pressed = c.effective_penetration();
  if (m.in_relaxation)
    c.at_rest = c.peak = pressed;
  const double part = std::min(1.0, m.omega_step / time_of_rest);
  c.at_rest += part * (pressed - c.at_rest);
  c.peak = std::max(pressed, c.peak - part * c.peak);
}

// Advances the force of restitution of a contact that is as deep as it is now, and its means. closing: m, in the step.
// Returns what it took, J, by the trapezoidal rule; what opens further than q leaves the spring at 0.
inline double advance_damping(Contact& c, const ContactLaw& law, const ContactMotion& m, double closing) {
  const double before = c.damping, q = before > 0 ? pressed_by_approach(c, law, part_damped(c, law)) : 0,
               stored = stored_by_damping(c, q);
  advance_rest(c, m);
  const double part = part_damped(c, law), stiffness = part * law.kn, pressed = c.effective_penetration();
  if (m.approach >= 0)
    c.damping = stiffness * std::clamp(q + closing, 0.0, m.approach * pressed);
  else
    c.damping = closing < 0 ? -stiffness * pressed * std::min(-m.approach, m.held_at_most) : 0;
  return 0.5 * before * (before > 0 ? std::max(closing, -q) : closing) +
         0.5 * c.damping *
             (closing > 0     ? m.part_of_step * closing
              : c.damping > 0 ? std::max(closing, -q)
                              : closing) +
         stored - stored_by_damping(c, pressed_by_approach(c, law, part));
}

// Near an end of one of its edges a crossing gives back what it stores before the edges slide off each other. At a distance y from the
// end, with x = y / (c p) < 1, it stores U = k p^2 w / 2. The forces are the derivatives of U: k p x^3 along the normal, and
// k p^2 w' / (2 c p), at most 0.6 k p, off the end. From y = p on the corner at the end may stand in the other body and press itself.
constexpr double reach_of_end = 1.25;   // c
inline double part_near_end(double x) { // w
  return x * x * (3 - 2 * x);
}
inline double force_near_end(double x) { // x^3 / w
  return x / (3 - 2 * x);
}
inline double slope_near_end(double x) { // w' / w
  return 6 * (1 - x) / (x * (3 - 2 * x));
}
// Largest second derivative of U by y, over k.
inline double most_stiff_near_end(const Contact& c) {
  return c.from_end < 1 ? 3 / (reach_of_end * reach_of_end) : 0;
}

// N, of the contact on its source.
inline double normal_force(const Contact& c, const ContactLaw& law) {
  return law.kn * c.effective_penetration() * force_near_end(c.from_end) + c.damping;
}

// N, on the source: its spring stores less as its area shrinks by slip, or as an end comes nearer.
inline geom::Vec3 along_face(const Contact& c, const ContactLaw& law) {
  const double pressed = c.effective_penetration(), of = c.from_end < 1 ? 1 : c.area;
  return of > 0 ? geom::Vec3(-0.5 * law.kn * pressed * pressed / of * c.widening) : geom::Vec3::Zero();
}

// t, of a contact that has moved that far along its normal in the last step, m.
inline double part_of_step(double pressed, double moved) {
  return pressed < std::abs(moved) ? pressed / std::abs(moved) : 1;
}

// Part of the normal force that acts.
inline double part_borne(const ContactMotion& m) {
  return 0.5 * (1 + m.part_of_step);
}

// Advances the means that friction follows, of a contact that is as deep as it is now. While it is open it keeps them: so the
// mean over the time in which it carries is that of the normal force, however much it bounces.
inline void advance_felt_force(Contact& c, const ContactLaw& law, const ContactMotion& m) {
  const double force = part_borne(m) * normal_force(c, law);
  if (!m.shares_friction || m.in_relaxation)
    c.usual_force = c.felt_force = force;
  else if (c.effective_penetration() > 0) {
    c.usual_force += std::min(1.0, m.omega_step / time_of_share) * (force - c.usual_force);
    c.felt_force += std::min(1.0, m.omega_step / time_of_feeling) * (force - c.felt_force);
  }
}

// N of friction.
inline double felt_by_friction(const Contact& c, const ContactLaw& law, const ContactMotion& m) {
  const double force = part_borne(m) * normal_force(c, law);
  if (!m.shares_friction)
    return force;
  const double rests = part_at_rest(c);
  return (1 - rests) * force + rests * c.usual_force * m.felt_over_usual;
}

// Advances the contact. Returns the energy that friction and damping took: the work of shear force and damping by the
// trapezoidal rule, which is what central differences do, less what they store more. With F0 the turned force before the
// step, T the trial force and F1 = T limit / |T| that of friction is (F0 + F1) . (T - F1) / (2 ks), and what turning took
// off the stored energy. Friction may give energy in a step in which the slip turns back.
inline ContactLoss advance(Contact& c, const ContactLaw& law, const ContactMotion& m) {
  geom::Vec3 shear = turned_with(c.shear, c.normal, m.normal);
  shear += m.turned * m.normal.cross(shear);
  const geom::Vec3 turned = shear;
  shear -= law.ks * (m.slid - m.slid.dot(m.normal) * m.normal);
  c.reference_penetration =
      std::min(c.reference_penetration,
               std::max(0.0, m.depth)); // it does not pull when it comes back from further out
  c.normal = m.normal;
  c.depth = m.depth;
  ContactLoss loss;
  if (law.damps) {
    loss.damping = advance_damping(c, law, m, -m.opened());
  } else { // its body has been turned rigid
    loss.damping = stored_by_damping(c, law);
    c.damping = 0;
  }
  advance_felt_force(c, law, m);
  const bool carries = c.effective_penetration() > 0;
  const double trial = shear.norm(),
               limit = carries ? friction_limit(felt_by_friction(c, law, m), law.tan_friction) : 0;
  const double by_turning = c.shear.squaredNorm() - turned.squaredNorm();
  c.shear = shear;
  if (law.ks <= 0)
    return loss;
  loss.friction = 0.5 * by_turning / law.ks;
  if (trial <= limit)
    return loss;
  c.shear *= held_by_friction(trial, limit);
  loss.friction += 0.5 * (turned.dot(shear) / trial + limit) * (trial - limit) / law.ks;
  return loss;
}

// J, stored.
inline double energy(const Contact& c, const ContactLaw& law) {
  const double pressed = c.effective_penetration();
  return 0.5 * law.kn * pressed * pressed + stored_by_damping(c, law) +
         (law.ks > 0 ? 0.5 * c.shear.squaredNorm() / law.ks : 0);
}

// J, loss of a contact that has ended; slid: slip in its last step. The loss is the stored energy less the work of its
// force in that step. The normal spring loses nothing if the contact opened.
inline double end_loss(const Contact& c, const ContactLaw& law, const geom::Vec3& slid) {
  const double pressed = c.effective_penetration(), opened = std::min(slid.dot(c.normal), pressed);
  const double of_damping =
      c.damping > 0 ? std::min(opened, pressed_by_approach(c, law, part_damped(c, law))) : opened;
  return 0.5 * law.kn * pressed * (pressed - opened) + stored_by_damping(c, law) -
         0.5 * c.damping * of_damping +
         (law.ks > 0 ? 0.5 * c.shear.squaredNorm() / law.ks - 0.5 * c.shear.dot(slid) : 0);
}

// J, that the normal spring loses when another face is suddenly nearer, as one that has just broken: what it stored at
// its depth before the step, less what it stores at the depth under the new face then.
inline double target_change_loss(const Contact& old, const ContactLaw& law, const ContactMotion& m) {
  const double before = m.depth + m.slid.dot(m.normal);
  const double left = std::clamp(before - old.reference_penetration, 0., old.effective_penetration());
  return 0.5 * law.kn * (old.effective_penetration() * old.effective_penetration() - left * left);
}

} // namespace cdem
