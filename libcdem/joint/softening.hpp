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
//
// The law is written once for one bond (T is double) and for several side by side (T is a vector of doubles).
#pragma once

#include "libcdem/joint/joint.hpp"
#include "libcdem/joint/spring_law.hpp"
#include "libcdem/parallel/exp.hpp"
#include "libcdem/parallel/triple.hpp"
#include "libgeom/core/portable.hpp"

namespace cdem {

constexpr double exponential_decay = 5; // a: the curve falls to 1/e in about a fifth of its length

// Integral of s from 0 to 1.
inline double softening_area(Softening curve) {
  if (curve == Softening::linear)
    return 0.5;
  return 1 / exponential_decay - 1 / (geom::portable::exp(exponential_decay) - 1);
}

template <class T>
struct SofteningLawOf {
  simd::MaskOf<T> softens{}, exponential{}; // else linear
  T kn{}, ks{};                             // Pa/m
  T cohesion{}, tan_friction{}, tensile_strength{};
  T opening{}; // w_I, m, from the strength to separation
  T slip{};    // w_II, m
};
using SofteningLaw = SofteningLawOf<double>;

enum class SofteningBegins : std::uint8_t { at_rest, at_strength };

// What a softening law takes from its joint.
template <class T>
struct SofteningJoint {
  simd::MaskOf<T> softens{}, exponential{};
  T cohesion{}, tan_friction{}, tensile_strength{};
  T energy_1{}, energy_2{}, area{}; // G_I, G_II, J/m2, and S
};

// tan_friction: of the joint's friction angle.
inline SofteningJoint<double> softening_values(const Joint& joint, double tan_friction) {
  return {joint.softening != Softening::none,
          joint.softening == Softening::exponential,
          joint.cohesion,
          tan_friction,
          joint.tensile_strength,
          joint.fracture_energy_1,
          joint.fracture_energy_2,
          softening_area(joint.softening)};
}

// w_I or w_II. At the least fracture energy the length is zero; a floor far below the elastic stretch keeps the quotients
// finite.
template <class T>
CDEM_INLINE T softening_length(const T& energy, const T& strength, const T& k, const T& area,
                               SofteningBegins begins) {
  const T stretching = begins == SofteningBegins::at_rest ? strength * strength / (2.0 * k) : T{};
  const T length = (energy - stretching) / (strength * area), least = 1e-9 * strength / k;
  return length < least ? least : length;
}

template <class T>
CDEM_INLINE SofteningLawOf<T> softening_law(const SofteningJoint<T>& joint, const T& kn, const T& ks,
                                            SofteningBegins begins) {
  const T none{};
  const T opening = softening_length(joint.energy_1, joint.tensile_strength, kn, joint.area, begins),
          slip = softening_length(joint.energy_2, joint.cohesion, ks, joint.area, begins);
  return {joint.softens,
          joint.exponential,
          kn,
          ks,
          joint.cohesion,
          joint.tan_friction,
          joint.tensile_strength,
          joint.softens ? opening : none,
          joint.softens ? slip : none};
}

// The joint has passed validate(joint, kn, ks).
inline SofteningLaw softening_law(const Joint& joint, double kn, double ks,
                                  SofteningBegins begins = SofteningBegins::at_rest) {
  return softening_law(softening_values(joint, geom::portable::tan(joint.friction_angle)), kn, ks, begins);
}

// s(xi), xi >= 0: what is left of the strength, 1 .. 0.
template <class T>
CDEM_INLINE T softening_curve(const simd::MaskOf<T>& exponential, const T& xi) {
  const T none{}, one = none + 1.0;
  const auto within = simd::below(xi, one);
  const T x = within ? xi : one;
  T left = one - x;
  if (simd::any(exponential)) {
    const double end = geom::portable::exp(-exponential_decay);
    const T curved = (exp_of<T>(-exponential_decay * x) - end) / (1 - end);
    left = exponential ? curved : left;
  }
  return within ? left : none;
}

// r, of a stretch with these parts, m: kn open and ks shear over the strength surface, in the direction of zero.
template <class T>
CDEM_INLINE T strength_ratio(const SofteningLawOf<T>& law, const T& open, const T& shear) {
  const T tn = law.kn * open, tension = tn / law.tensile_strength,
          sliding = cohesive_load<T>(law.ks * shear, law.tan_friction, tn) / law.cohesion;
  return tension < sliding ? sliding : tension;
}

template <class T>
struct StrengthLeft {
  T part{};                // s(xi)
  simd::MaskOf<T> opens{}; // opening is the larger part of xi
};

// r: strength_ratio of this stretch, at least 1.
template <class T>
CDEM_INLINE StrengthLeft<T> strength_left(const SofteningLawOf<T>& law, const T& open, const T& shear,
                                          const T& r) {
  const T none{}, one = none + 1.0;
  const T beyond = one - one / r, tn = law.kn * open;
  const T pressure = none < -tn ? -tn : none;
  const T held = friction_limit<T>(pressure, law.tan_friction) / law.ks; // m, by friction alone
  const T slid = shear - held;
  const T xi_n = (none < open ? open : none) * beyond / law.opening;
  const T xi_s = (none < slid ? slid : none) * beyond / law.slip;
  return {softening_curve<T>(law.exponential, root(xi_n * xi_n + xi_s * xi_s)), simd::at_most(xi_s, xi_n)};
}

template <class T>
struct DamageDrive {
  T damage{};              // 1 - s(xi) / r, 0 inside the strength surface
  simd::MaskOf<T> opens{}; // opening is the larger part of xi
};

// open, shear: parts of the stretch, m.
template <class T>
CDEM_INLINE DamageDrive<T> damage_drive(const SofteningLawOf<T>& law, const T& open, const T& shear) {
  const T none{}, one = none + 1.0;
  const T r = strength_ratio<T>(law, open, shear);
  const auto beyond_strength = simd::below(one, r);
  if (!simd::any(beyond_strength))
    return {};
  const T at = beyond_strength ? r : one;
  const StrengthLeft<T> left = strength_left<T>(law, open, shear, at);
  const T damage = left.part > none ? one - left.part / at : one;
  return {beyond_strength ? damage : none, left.opens};
}

template <class T>
struct SofteningResponse {
  Triple<T> traction{}; // Pa
  Triple<T> contact{};  // Pa, t_c of the damaged part
  Triple<T> slip{};     // m, new slip of the damaged part; that of a whole bond means nothing
  T damage{};
  simd::MaskOf<T> separated{}, opens{}; // by this step, and by opening rather than by slip
};

inline BondMode mode_of(const SofteningResponse<double>& r) {
  return !r.separated ? BondMode::intact : r.opens ? BondMode::broken_tension : BondMode::broken_shear;
}

// damage, slip: before. grows: damage may advance.
template <class T>
CDEM_INLINE SofteningResponse<T> softening_response(const SofteningLawOf<T>& law, const Triple<T>& normal,
                                                    const Triple<T>& stretch, const T& damage,
                                                    const Triple<T>& slip, const simd::MaskOf<T>& grows) {
  const T one = T{} + 1.0;
  const T open = dot(stretch, normal);
  const Triple<T> shear = stretch - open * normal;
  SofteningResponse<T> r;
  r.damage = damage;
  if (simd::any(grows)) {
    const DamageDrive<T> drive = damage_drive<T>(law, open, root(dot(shear, shear)));
    r.damage = grows ? (damage < drive.damage ? drive.damage : damage) : damage;
    r.separated = grows & simd::at_most(one, drive.damage);
    r.opens = drive.opens;
  }
  const SpringResponseOf<T> contact =
      contact_response<T>(law.kn, law.ks, law.tan_friction, normal, stretch, slip);
  r.contact = contact.traction;
  r.slip = contact.offset;
  const Triple<T> bonded = (law.kn * open) * normal + law.ks * shear;
  r.traction = (one - r.damage) * bonded + r.damage * contact.traction;
  return r;
}

// J/m2; contact: t_c.
template <class T>
CDEM_INLINE T softening_stored(const SofteningLawOf<T>& law, const Triple<T>& normal,
                               const Triple<T>& stretch, const T& damage, const Triple<T>& contact) {
  const T open = dot(stretch, normal), contact_normal = dot(contact, normal);
  const T bonded = law.kn * open * open + law.ks * (dot(stretch, stretch) - open * open);
  const T rubbing = contact_normal * contact_normal / law.kn +
                    (dot(contact, contact) - contact_normal * contact_normal) / law.ks;
  return 0.5 * ((1.0 - damage) * bonded + damage * rubbing);
}

template <class T>
struct SofteningLoss {
  T friction{}, breaking{}; // J/m2
};

// Part of what damage takes at this stretch that shear has, by kn <e_n>^2 : ks |e_s|^2; 1 where it is closed.
template <class T>
CDEM_INLINE T shear_share(const SofteningLawOf<T>& law, const Triple<T>& normal, const Triple<T>& stretch) {
  const T none{}, one = none + 1.0;
  const T open = dot(stretch, normal);
  const Triple<T> shear = stretch - open * normal;
  const T opening = law.kn * open * open, slip = law.ks * dot(shear, shear), both = opening + slip;
  const auto some = simd::below(none, both);
  const T share = some ? slip / (some ? both : one) : none;
  return open > none ? share : one;
}

// What a step from stretch0 (with damage0 and slip0) to stretch1 lost: work by the trapezoidal rule less the
// change of what is stored. Friction is the work of t_c over the growth of D slip, the spring's whole
// inelastic slip (closed, t_s = ks (e_s - D slip)); the rest, dD (kn <e_n>^2 + ks slip^2) / 2, is what the
// damage took.
template <class T>
CDEM_INLINE SofteningLoss<T> softening_loss(const SofteningLawOf<T>& law, const Triple<T>& normal,
                                            const Triple<T>& stretch0, const T& damage0,
                                            const Triple<T>& slip0, const Triple<T>& stretch1,
                                            const SofteningResponse<T>& now) {
  const simd::MaskOf<T> never{};
  const SofteningResponse<T> before = softening_response<T>(law, normal, stretch0, damage0, slip0, never);
  const T work = 0.5 * dot(before.traction + now.traction, stretch1 - stretch0);
  const T stored = softening_stored<T>(law, normal, stretch1, now.damage, now.contact) -
                   softening_stored<T>(law, normal, stretch0, damage0, before.contact);
  SofteningLoss<T> loss;
  loss.friction = 0.5 * dot(before.contact + now.contact, now.damage * now.slip - damage0 * before.slip);
  loss.breaking = work - stored - loss.friction;
  return loss;
}

} // namespace cdem
