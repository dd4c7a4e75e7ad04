// Softening of a bond between its strength and its separation, per area: a cohesive law with one damage variable D. The
// damaged part of the area has friction like a contact (Alfano and Sacco 2006, Int. J. Numer. Meth. Engng 68).
//
//   t      = (1 - D) K e + D t_c
//   stored = (1 - D) e.K e / 2 + D t_c.K^-1 t_c / 2
//
// e = j - o is the elastic relative displacement, K = kn n n + ks (1 - n n), and t_c the traction of a contact at the
// same e (Han 2010 eq 9). r is the ratio of the elastic trial t = K e to the strength surface (Han 2010 eqs 10-11,
// signed t_n). w_n and w_s are the inelastic opening and slip:
//
//   r   = max(t_n / sigma_t, (|t_s| + t_n tan(phi)) / c0)
//   w_n = (1 - 1/r) <e_n>
//   w_s = (1 - 1/r) <|e_s| - <-e_n> kn tan(phi) / ks>
//   xi  = sqrt((w_n / w_I)^2 + (w_s / w_II)^2)
//   D   = max(D so far, 1 - s(xi) / r)
//
// with s the remaining fraction of the strength (0 from xi = 1 on) and S its integral over 0..1,
//
//   linear       s = 1 - xi
//   exponential  s = (exp(-a xi) - exp(-a)) / (1 - exp(-a)),   a = 5
//
//   w_I  = (G_I  - sigma_t^2 / 2 kn) / (sigma_t S)
//   w_II = (G_II - c0^2 / 2 ks) / (c0 S)
//
// Between blocks the elastic energy of the spring at its strength is part of G, and is subtracted. A crack of a
// cohesive body begins at its strength with zero opening, so nothing is subtracted there.
//
// While D grows the traction stays on the strength surface with sigma_t and c0 both multiplied by s: pure
// opening takes G_I, slip under a constant pressure p takes G_II beyond the work of the friction p tan(phi).
// At a fixed ratio of opening to slip, the ray of e (direction d, open) meets the surface at t_0 and e_0, and
// separation takes
//
//   t_0.e_0 / 2 + S t_0.d / sqrt((d_n / w_I)^2 + (d_s / w_II)^2)
#pragma once

#include "libcdem/joint/joint.hpp"
#include "libcdem/joint/spring_law.hpp"
#include "libgeom/core/portable.hpp"

namespace cdem {

constexpr double exponential_decay = 5; // a: the curve falls to 1/e in about a fifth of its length

// s(xi), xi >= 0: what is left of the strength, 1 .. 0.
inline double softening_curve(Softening curve, double xi) {
  if (xi >= 1)
    return 0;
  if (curve == Softening::linear)
    return 1 - xi;
  const double end = geom::portable::exp(-exponential_decay);
  return (geom::portable::exp(-exponential_decay * xi) - end) / (1 - end);
}

// Integral of s from 0 to 1.
inline double softening_area(Softening curve) {
  if (curve == Softening::linear)
    return 0.5;
  return 1 / exponential_decay - 1 / (geom::portable::exp(exponential_decay) - 1);
}

struct SofteningLaw {
  Softening curve = Softening::none;
  double kn = 0, ks = 0; // Pa/m
  SpringStrength strength;
  double opening = 0; // w_I, m, from the strength to separation
  double slip = 0;    // w_II, m

  bool softens() const { return curve != Softening::none; }
};

enum class SofteningBegins : std::uint8_t { at_rest, at_strength };

// The joint has passed validate(joint, kn, ks). tan_friction: of its friction angle.
inline SofteningLaw softening_law(const Joint& joint, double tan_friction, double kn, double ks,
                                  SofteningBegins begins = SofteningBegins::at_rest) {
  SofteningLaw law;
  law.curve = joint.softening;
  law.kn = kn;
  law.ks = ks;
  law.strength = {joint.cohesion, tan_friction, joint.tensile_strength};
  if (!law.softens())
    return law;
  // At the least fracture energy the length is zero; a floor far below the elastic stretch keeps the
  // quotients finite.
  const auto length = [&](double energy, double strength, double k) {
    const double stretching = begins == SofteningBegins::at_rest ? strength * strength / (2 * k) : 0;
    return std::max((energy - stretching) / (strength * softening_area(law.curve)), 1e-9 * strength / k);
  };
  law.opening = length(joint.fracture_energy_1, joint.tensile_strength, kn);
  law.slip = length(joint.fracture_energy_2, joint.cohesion, ks);
  return law;
}

inline SofteningLaw softening_law(const Joint& joint, double kn, double ks) {
  return softening_law(joint, geom::portable::tan(joint.friction_angle), kn, ks);
}

struct DamageDrive {
  double damage = 0;                // 1 - s(xi) / r, 0 inside the strength surface
  BondMode mode = BondMode::intact; // which part of xi is the larger, where damage is 1
};

// open, shear: parts of the stretch, m.
inline DamageDrive damage_drive(const SofteningLaw& law, double open, double shear) {
  const double tn = law.kn * open;
  const double r =
      std::max(tn / law.strength.tensile_strength,
               cohesive_load(law.ks * shear, law.strength.tan_friction, tn) / law.strength.cohesion);
  if (!(r > 1))
    return {};
  const double beyond = 1 - 1 / r;
  const double held =
      friction_limit(std::max(0.0, -tn), law.strength.tan_friction) / law.ks; // m, by friction alone
  const double xi_n = std::max(0.0, open) * beyond / law.opening;
  const double xi_s = std::max(0.0, shear - held) * beyond / law.slip;
  const double left = softening_curve(law.curve, std::sqrt(xi_n * xi_n + xi_s * xi_s));
  if (left > 0)
    return {1 - left / r, BondMode::intact};
  return {1, xi_n >= xi_s ? BondMode::broken_tension : BondMode::broken_shear};
}

struct SofteningResponse {
  geom::Vec3 traction = geom::Vec3::Zero(); // Pa
  geom::Vec3 contact = geom::Vec3::Zero();  // Pa, t_c of the damaged part
  geom::Vec3 slip = geom::Vec3::Zero(); // m, new slip of the damaged part; that of a whole bond means nothing
  double damage = 0;
  BondMode mode = BondMode::intact; // broken_* when this step separated the bond
};

// damage, slip: before. grows: damage may advance.
inline SofteningResponse softening_response(const SofteningLaw& law, const geom::Vec3& normal,
                                            const geom::Vec3& stretch, double damage, const geom::Vec3& slip,
                                            bool grows) {
  const double open = stretch.dot(normal);
  const geom::Vec3 shear = stretch - open * normal;
  SofteningResponse r;
  r.damage = damage;
  if (grows) {
    const DamageDrive drive = damage_drive(law, open, shear.norm());
    r.damage = std::max(damage, drive.damage);
    r.mode = drive.mode;
  }
  const SpringResponse contact =
      contact_response(law.kn, law.ks, law.strength.tan_friction, normal, stretch, slip);
  r.contact = contact.traction;
  r.slip = contact.offset;
  r.traction = (1 - r.damage) * (law.kn * open * normal + law.ks * shear) + r.damage * contact.traction;
  return r;
}

// J/m2; contact: t_c.
inline double softening_stored(const SofteningLaw& law, const geom::Vec3& normal, const geom::Vec3& stretch,
                               double damage, const geom::Vec3& contact) {
  const double open = stretch.dot(normal), contact_normal = contact.dot(normal);
  const double bonded = law.kn * open * open + law.ks * (stretch.squaredNorm() - open * open);
  const double rubbing = contact_normal * contact_normal / law.kn +
                         (contact.squaredNorm() - contact_normal * contact_normal) / law.ks;
  return 0.5 * ((1 - damage) * bonded + damage * rubbing);
}

struct SofteningLoss {
  double friction = 0, breaking = 0; // J/m2
};

// Part of what damage takes at this stretch that shear has, by kn <e_n>^2 : ks |e_s|^2; 1 where it is closed.
inline double shear_share(const SofteningLaw& law, const geom::Vec3& normal, const geom::Vec3& stretch) {
  const double open = stretch.dot(normal);
  if (!(open > 0))
    return 1;
  const double opening = law.kn * open * open, slip = law.ks * (stretch - open * normal).squaredNorm();
  return opening + slip > 0 ? slip / (opening + slip) : 0;
}

// What a step from stretch0 (with damage0 and slip0) to stretch1 lost: work by the trapezoidal rule less the
// change of what is stored. Friction is the work of t_c over the growth of D slip, the spring's whole
// inelastic slip (closed, t_s = ks (e_s - D slip)); the rest, dD (kn <e_n>^2 + ks slip^2) / 2, is what the
// damage took.
inline SofteningLoss softening_loss(const SofteningLaw& law, const geom::Vec3& normal,
                                    const geom::Vec3& stretch0, double damage0, const geom::Vec3& slip0,
                                    const geom::Vec3& stretch1, const SofteningResponse& now) {
  const SofteningResponse before = softening_response(law, normal, stretch0, damage0, slip0, false);
  SofteningLoss loss;
  const double work = 0.5 * (before.traction + now.traction).dot(stretch1 - stretch0);
  const double stored = softening_stored(law, normal, stretch1, now.damage, now.contact) -
                        softening_stored(law, normal, stretch0, damage0, before.contact);
  loss.friction = 0.5 * (before.contact + now.contact).dot(now.damage * now.slip - damage0 * before.slip);
  loss.breaking = work - stored - loss.friction;
  return loss;
}

} // namespace cdem
