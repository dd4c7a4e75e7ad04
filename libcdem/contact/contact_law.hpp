// Law of one contact (Feng 2014 eqs 15-18 with T = C = 0): pure functions.
//
//   Fn = kn (d - d0)+            d depth below the target's surface; d0 = 0, or the depth at which it was found
//   Fs = R Fs - ks du_s          R turns it with the normal, and about it with the two faces; du_s slip of this step
//   |Fs| <= Fn tan(phi)
//
// An overlap that is there before anything moved (d0 > 0) carries nothing: at the stiffness of concrete a tenth of a
// millimetre would throw a unit into the air.
#pragma once

#include "libcdem/state/contact.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

struct ContactLaw {
  double kn = 0, ks = 0; // N/m
  double tan_friction = 0;
};

// What has happened to a contact since it was last looked at.
struct ContactMotion {
  geom::Vec3 normal = geom::Vec3::Zero(); // unit, out of the target, now
  double depth = 0;                       // m, now
  geom::Vec3 slid = geom::Vec3::Zero();   // m, of the source past the target
  double turned = 0;                      // rad, of the two faces about the normal
};

// A vector at right angles to the unit vector `from`, turned the shortest way to `to`.
inline geom::Vec3 turned_with(const geom::Vec3& v, const geom::Vec3& from, const geom::Vec3& to) {
  const double c = from.dot(to);
  if (c < -0.5) // not a motion but another face
    return v - v.dot(to) * to;
  return v - v.dot(to) / (1 + c) * (from + to);
}

// Where a contact that is new starts to carry: at the surface when it got this deep within the step.
inline double start_depth(const ContactMotion& m) {
  return m.depth <= -1.5 * m.slid.dot(m.normal) ? 0 : m.depth;
}

// Advances the contact. Returns the energy that friction took, J: the work of the shear force by the trapezoidal rule,
// which is what central differences do, less what the spring stores more. With F0 the turned force before the step, T the
// trial force and F1 = T limit / |T| that is (F0 + F1) . (T - F1) / (2 ks), and what turning took off the stored energy.
// A step in which the slip turns back may give energy.
inline double advance(Contact& c, const ContactLaw& law, const ContactMotion& m) {
  geom::Vec3 shear = turned_with(c.shear, c.normal, m.normal);
  shear += m.turned * m.normal.cross(shear);
  const geom::Vec3 turned = shear;
  shear -= law.ks * (m.slid - m.slid.dot(m.normal) * m.normal);
  c.start = std::min(c.start, std::max(0.0, m.depth)); // it does not pull when it comes back from further out
  c.normal = m.normal;
  c.depth = m.depth;
  const double trial = shear.norm(), limit = law.kn * c.pressed() * law.tan_friction;
  const double by_turning = c.shear.squaredNorm() - turned.squaredNorm();
  c.shear = shear;
  if (law.ks <= 0)
    return 0;
  if (trial <= limit)
    return 0.5 * by_turning / law.ks;
  c.shear *= limit / trial;
  return 0.5 * ((turned.dot(shear) / trial + limit) * (trial - limit) + by_turning) / law.ks;
}

// J, stored.
inline double energy(double pressed, double shear_force, const ContactLaw& law) {
  return 0.5 * law.kn * pressed * pressed + (law.ks > 0 ? 0.5 * shear_force * shear_force / law.ks : 0);
}

// J, that a contact loses which acts no more, having slid by this in its last step: what it stored, less the work of its
// force in that step. Of the normal spring that is nothing when it opened.
inline double end_loss(const Contact& c, const ContactLaw& law, const geom::Vec3& slid) {
  const double pressed = c.pressed(), opened = std::min(slid.dot(c.normal), pressed);
  return 0.5 * law.kn * pressed * (pressed - opened) +
         (law.ks > 0 ? 0.5 * c.shear.squaredNorm() / law.ks - 0.5 * c.shear.dot(slid) : 0);
}

// J, that the normal spring loses when another face is suddenly nearer, as one that has just broken: what it stored at
// its depth before the step, less what it stores at the depth under the new face then.
inline double jump_loss(const Contact& old, const ContactLaw& law, const ContactMotion& m) {
  const double before = m.depth + m.slid.dot(m.normal);
  const double left = std::clamp(before - old.start, 0., old.pressed());
  return 0.5 * law.kn * (old.pressed() * old.pressed() - left * left);
}

} // namespace cdem
