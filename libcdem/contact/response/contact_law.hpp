// Law of one contact (Feng 2014 eqs 15-18 with T = C = 0): pure functions.
//
//   Fn = kn (d - d0)+            d depth below the target's surface; d0 = 0, or the depth at which it was found
//   Fs = R Fs - ks du_s          R turns it with the normal, and about it with the two faces; du_s slip of this step
//   |Fs| <= Fn tan(phi)
//
// With a coefficient of restitution e < 1 the normal force is larger while the two points approach and smaller while
// they separate, so that the contact returns the fraction e^2 of the energy 1/2 kn d^2:
//
//   Fn = kn (d - d0)+ [(1 + e^2)/2 + (1 - e^2)/2 s],   s = v / v0 within -1 and 1,   v approach speed
//
// v0 is the speed that the forces of one step can reverse, so that a body at rest stays at rest. While s stays, the force is
// that of a spring, whose energy is stored. Damping is what a change of s takes, (1 - e^2)/4 kn (d - d0)^2 as s falls by 1.
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
  double damping_ratio = 0; // (1 - e^2) / (1 + e^2)
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
  double speed = 0;                       // m/s, of approach
  double turning_speed = 0;               // v0, m/s
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
  return m.depth <= -1.5 * m.slid.dot(m.normal) ? 0 : m.depth;
}

// N, of a contact pressed by `elastic` (N) by its spring.
inline double contact_damping(double elastic, const ContactLaw& law, double speed, double turning_speed) {
  if (law.damping_ratio == 0 || speed == 0)
    return 0;
  const double part = turning_speed > std::abs(speed) ? speed / turning_speed : std::copysign(1., speed);
  return law.damping_ratio * elastic * part;
}

// J, stored in the part of the normal force that depends on s.
inline double stored_by_damping(const Contact& c) {
  return 0.5 * c.damping * c.effective_penetration();
}

// Advances the contact. Returns the energy that friction and damping took: the work of shear force and damping by the
// trapezoidal rule, which is what central differences do, less what they store more. With F0 the turned force before the
// step, T the trial force and F1 = T limit / |T| that of friction is (F0 + F1) . (T - F1) / (2 ks), and what turning took
// off the stored energy. A step in which the slip turns back may give energy.
inline ContactLoss advance(Contact& c, const ContactLaw& law, const ContactMotion& m) {
  geom::Vec3 shear = turned_with(c.shear, c.normal, m.normal);
  shear += m.turned * m.normal.cross(shear);
  const geom::Vec3 turned = shear;
  const double stored_before = stored_by_damping(c);
  shear -= law.ks * (m.slid - m.slid.dot(m.normal) * m.normal);
  c.reference_penetration =
      std::min(c.reference_penetration,
               std::max(0.0, m.depth)); // it does not pull when it comes back from further out
  c.normal = m.normal;
  c.depth = m.depth;
  ContactLoss loss;
  const double elastic = law.kn * c.effective_penetration();
  const double damping = contact_damping(elastic, law, m.speed, m.turning_speed);
  loss.damping = -0.5 * (c.damping + damping) * m.slid.dot(m.normal);
  c.damping = damping;
  loss.damping += stored_before - stored_by_damping(c);
  const double trial = shear.norm(), limit = friction_limit(elastic + damping, law.tan_friction);
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

// N/m, of the normal force over the depth that it acts at.
inline double stiffness_now(const Contact& c, const ContactLaw& law) {
  const double pressed = c.effective_penetration();
  return pressed > 0 ? law.kn + c.damping / pressed : law.kn;
}

// J, stored. normal: N/m.
inline double energy(double pressed, double normal, double shear_force, const ContactLaw& law) {
  return 0.5 * normal * pressed * pressed + (law.ks > 0 ? 0.5 * shear_force * shear_force / law.ks : 0);
}
inline double energy(const Contact& c, const ContactLaw& law) {
  return energy(c.effective_penetration(), stiffness_now(c, law), c.shear.norm(), law);
}

// J, loss of a contact that has ended; slid: slip in its last step. The loss is the stored energy less the work of its
// force in that step. The normal spring loses nothing if the contact opened.
inline double end_loss(const Contact& c, const ContactLaw& law, const geom::Vec3& slid) {
  const double pressed = c.effective_penetration(), opened = std::min(slid.dot(c.normal), pressed);
  return 0.5 * stiffness_now(c, law) * pressed * (pressed - opened) +
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
