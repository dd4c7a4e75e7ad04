// Law of one spring between two faces, per area (Han 2010 eqs 8-11 as amended in docs/theory.md).
//
//   bonded:   t = kn (j - o).n n + ks (j - o)_s,   j relative displacement from a to b, o that at t = 0
//
// broken or never bonded:
//   closed (t_n <= 0):  the same, |t_s| limited to |t_n| tan(phi), o_s slips with it
//   open (t_n > 0):     t = 0, o_s follows j_s so that a closing face starts without shear
//
// A bond that softens between the two states: joint/softening.hpp.
//
// A contact that slides does not feel a change of its normal force at once (Prakash 1998, J. Tribol. 120, 97-102). If it did,
// friction would feed the vibrations of a deformable block, whose springs then slide while little presses them (Adams 1998, J. Appl.
// Mech. 65, 470-475). So where a block deforms, friction acts on
//
//   N = (1 - r^4) F + r^4 M,    d r / dt = omega / 10 while F > 0, else -omega / 10,  0 <= r <= 1
//                               d M / dt = (F - M) omega / (10 r) while F > 0
//
// F is what presses, M its mean over the time in which the contact carries, and r the part of the time of means for which it has
// carried, less that for which it was open. In an impact r^4 is below 0.01. omega is that of the block on the spring
// (rest_rate in bond_work.cpp).
#pragma once

#include "libcdem/joint/coulomb_friction.hpp"
#include "libcdem/joint/mohr_coulomb.hpp"
#include "libcdem/parallel/triple.hpp"
#include "libgeom/core/types.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

// What a contact keeps of the trial kn e_n n + ks e_s: parts of its normal and its shear load. The rest of the shear, 1 -
// shear, slips. T: one number or several side by side, per area or for a whole spring.
template <class T>
struct HeldByContact {
  T normal, shear;
};

// viscous: what a dashpot adds to the normal force kn open, at most as much as presses, and what friction does not feel of the
// two. Friction acts on both: dashpots bear a part of the weight of what slides, as they press more than they pull.
template <class T>
CDEM_INLINE HeldByContact<T> held_by_contact(const T& kn, const T& ks, const T& tan_friction, const T& open,
                                             const T& shear_length, const T& viscous = T{}) {
  const T none = T{}, all = none + 1.0;
  const T held =
      held_by_friction<T>(ks * shear_length, friction_limit<T>(-(kn * open + viscous), tan_friction));
  const auto apart = simd::below(none, open);
  return {apart ? none : all, apart ? none : held};
}

// How far a spring is stretched along its normal and across it, m.
template <class T>
struct SpringStretch {
  T open;
  Triple<T> shear;
};

template <class T>
CDEM_INLINE SpringStretch<T> parts_of(const Triple<T>& stretch, const Triple<T>& normal) {
  const T open = dot(stretch, normal);
  return {open, stretch - open * normal};
}

// N, of a whole spring, kn and ks in N/m; a bond holds all of its load.
template <class T>
CDEM_INLINE Triple<T> spring_force(const T& kn, const T& ks, const Triple<T>& normal,
                                   const SpringStretch<T>& stretch, const HeldByContact<T>& held) {
  return (held.normal * (kn * stretch.open)) * normal + (held.shear * ks) * stretch.shear;
}

// J, that a contact loses as it slips, m; before: its force in the step before, N.
template <class T>
CDEM_INLINE T lost_by_slip(const T& ks, const Triple<T>& normal, const SpringStretch<T>& stretch,
                           const HeldByContact<T>& held, const Triple<T>& before, const Triple<T>& slip) {
  const Triple<T> shear_before = before - dot(before, normal) * normal;
  return 0.5 * dot(shear_before + (held.shear * ks) * stretch.shear, slip);
}

// N, the shear that friction would hold beside that of a contact under a normal force (< 0 where it is pressed).
template <class T>
CDEM_INLINE T friction_left(const T& ks, const T& tan_friction, const T& normal_force,
                            const T& shear_length) {
  const T left = friction_limit<T>(-normal_force, tan_friction) - ks * shear_length;
  return left > T{} ? left : T{};
}

// Stiffness damping of a contact beside its own force, along the normal: it takes no tension, and nothing while the contact
// is open. damping: s; opening: m/s; normal_force: N, its own, < 0 where it is pressed.
template <class T>
CDEM_INLINE T viscous_along(const T& damping, const T& kn, const T& opening, const T& normal_force) {
  const T none{}, wanted = (damping * kn) * opening, pressing = none - normal_force;
  return simd::below(normal_force, none) ? (wanted < pressing ? wanted : pressing) : none;
}

// And across it: none while it slides, and no more than friction leaves. rate: m/s, of the stretch.
template <class T, class Mask>
CDEM_INLINE Triple<T> viscous_across(const T& damping, const T& ks, const Triple<T>& normal,
                                     const Triple<T>& rate, const T& friction_left, const Mask& sticks) {
  const T part = sticks ? damping * ks : T{};
  const Triple<T> shear = part * (rate - dot(rate, normal) * normal);
  return held_by_friction<T>(root(dot(shear, shear)), friction_left) * shear;
}

// What a contact remembers of its normal force: M, N, and r.
template <class T>
struct ContactMeans {
  T usual, rested;
};

// N, F - N: what friction does not feel of the force `pressed`, >= 0, of now. passed: part of the time of means that has passed
// in the step, by which the means advance; 0: the contact has none.
template <class T>
CDEM_INLINE T unfelt_by_friction(const T& pressed, const T& passed, ContactMeans<T>& means) {
  const T none{}, one = none + 1.0, more = means.rested + passed, less = means.rested - passed;
  const auto carries = simd::below(none, pressed) & simd::below(none, passed);
  const T grown = more < one ? more : one, shrunk = less > none ? less : none;
  means.rested = carries ? grown : shrunk;
  const T mean = means.usual + passed / (carries ? grown : one) * (pressed - means.usual);
  means.usual = carries ? mean : means.usual;
  const T rested2 = means.rested * means.rested, part = carries ? rested2 * rested2 : none;
  return part * (pressed - means.usual);
}

// N, what friction feels beside the normal force (< 0 where it is pressed) of a contact: `viscous` less what is unfelt.
template <class T>
CDEM_INLINE T felt_beside(const T& normal_force, const T& viscous, const T& passed, T& usual, T& rested) {
  const T none{}, pressing = none - (normal_force + viscous);
  ContactMeans<T> means{usual, rested};
  const T unfelt = unfelt_by_friction<T>(pressing > none ? pressing : none, passed, means);
  usual = means.usual;
  rested = means.rested;
  return viscous + unfelt;
}

template <class T>
struct SpringResponseOf {
  Triple<T> traction{}; // Pa, pulls a towards b when along the normal
  Triple<T> offset{};   // m, new o
};

template <class T>
CDEM_INLINE SpringResponseOf<T> contact_response(const T& kn, const T& ks, const T& tan_friction,
                                                 const Triple<T>& normal, const Triple<T>& jump,
                                                 const Triple<T>& offset) {
  const Triple<T> stretch = jump - offset;
  const T open = dot(stretch, normal);
  const Triple<T> shear = stretch - open * normal;
  const HeldByContact<T> held = held_by_contact<T>(kn, ks, tan_friction, open, root(dot(shear, shear)));
  return {(held.normal * kn * open) * normal + (held.shear * ks) * shear,
          offset + (1.0 - held.shear) * shear};
}

struct SpringResponse {
  geom::Vec3 traction, offset; // as above
};

inline SpringResponse contact_response(double kn, double ks, double tan_friction, const geom::Vec3& normal,
                                       const geom::Vec3& jump, const geom::Vec3& offset) {
  const SpringResponseOf<double> r =
      contact_response<double>(kn, ks, tan_friction, triple(normal), triple(jump), triple(offset));
  return {vec(r.traction), vec(r.offset)};
}

// J/m2, that a spring of these stiffnesses stores under a traction.
inline double stored_in_spring(double kn, double ks, const geom::Vec3& normal, const geom::Vec3& traction) {
  const double tn = traction.dot(normal);
  return 0.5 * (tn * tn / kn + (traction.squaredNorm() - tn * tn) / ks);
}

// Energy a spring lost over a step in which its traction went from t0 to t1 while its stretch would have become
// `trial` with the offset held: work of the motion by the trapezoidal rule (which is what central differences do) less
// the change of what is stored, J/m2. k: the stiffness in the direction of these vectors.
inline double lost_energy(double k, const geom::Vec3& t0, const geom::Vec3& t1, const geom::Vec3& trial) {
  return 0.5 * (t0 + t1).dot(trial - t0 / k) - 0.5 * (t1.squaredNorm() - t0.squaredNorm()) / k;
}

} // namespace cdem
