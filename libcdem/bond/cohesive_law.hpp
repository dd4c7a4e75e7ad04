// What one point of a cracking face carries and stores, per area (bond/freed_face.hpp). Vectors stand in the face's own
// axes; j is the relative displacement since the crack began. T: double, or a vector of doubles for the points of several faces.
//
// The law begins drawn by w0: as if a spring of the stiffness k carried what stood there. Pressure, and the shear that its
// friction holds, are w_f; what tension and cohesion held is w_c = w0 - w_f. With D = 1 - lambda the damage:
//
//   t = lambda k (j + w_f + a w_c) + (1 - lambda) t_c          t_c: the contact's at j + w_f
//
// While the crack goes on, lambda falls so that t stays on the strength surface, with s(xi) of joint/softening.hpp left of the
// strength (xi: that of j + w0), and a falls with lambda^4, but not where j goes against w_c, which would give energy.
// So a face that unloads has no traction at j = -a w_c: next to the origin once it is damaged by a tenth, and it gives back
// no more than it took.
#pragma once

#include "libcdem/joint/softening.hpp"
#include "libcdem/state/cohesive_face.hpp"

namespace cdem {

// What a point remembers.
template <class T>
struct CohesivePoint {
  Triple<T> plane{};  // m, unit normal of the critical plane
  Triple<T> offset{}; // m, w0
  Triple<T> start{};  // m, the law's j is the relative displacement since this one
  Triple<T> rest{};   // Pa, r0
  Triple<T> slip{};   // m, of the damaged part
  T damage{};         // D
  T drawn{};          // a
};

inline CohesivePoint<double> cohesive_point(const CohesiveFace& face, int point) {
  const auto triple = [](const CohesiveFace::Vector& v) { return Triple<double>{v[0], v[1], v[2]}; };
  return {triple(face.plane),       triple(face.offset[point]), triple(face.start[point]),
          triple(face.rest[point]), triple(face.slip[point]),   face.damage[point],
          face.drawn[point]};
}

template <class T>
CDEM_INLINE T fourth_power(const T& x) {
  return (x * x) * (x * x);
}

// The two parts of a stretch, m.
template <class T>
struct PartsOfStretch {
  Triple<T> pressed; // w_f
  Triple<T> bonded;  // w_c
};

template <class T>
CDEM_INLINE PartsOfStretch<T> parts_of_stretch(const SofteningLawOf<T>& law, const Triple<T>& normal,
                                               const Triple<T>& stretch) {
  const T none{}, one = none + 1.0;
  const T open = dot(stretch, normal);
  const Triple<T> along = stretch - open * normal;
  const T shear = root(dot(along, along)),
          held = friction_limit<T>(none < -open ? -open : none, law.tan_friction);
  const auto slips = simd::below(held, shear);
  const T slipping = slips ? (shear - held) / (slips ? shear : one) : none;
  const Triple<T> bonded = (none < open ? open : none) * normal + slipping * along;
  return {stretch - bonded, bonded};
}

template <class T>
CDEM_INLINE T strength_ratio(const SofteningLawOf<T>& law, const Triple<T>& normal,
                             const Triple<T>& stretch) {
  const T open = dot(stretch, normal);
  const Triple<T> shear = stretch - open * normal;
  return strength_ratio<T>(law, open, root(dot(shear, shear)));
}

template <class T>
struct CohesiveResponse {
  Triple<T> traction{};                 // Pa, on side a
  Triple<T> across{};                   // Pa, t, across the plane
  Triple<T> contact{};                  // Pa, t_c
  Triple<T> slip{};                     // m, new slip of the damaged part
  Triple<T> stretch{};                  // m, j + w_f + a w_c
  T damage{}, drawn{};                  // new D and a
  simd::MaskOf<T> separated{}, opens{}; // by this step, and by opening rather than by slip
};

// Steps of Newton's method towards the strength surface. They come from outside and never go beyond it, as the slope is not
// less than the true one; what is left goes with the next step of time.
constexpr int cohesive_iterations = 4;

// grows: damage may advance. torn: what is left of the strength goes at once (turned_away).
template <class T>
CDEM_INLINE CohesiveResponse<T> cohesive_response(const SofteningLawOf<T>& law, const CohesivePoint<T>& at,
                                                  const Triple<T>& jump, const simd::MaskOf<T>& grows,
                                                  const simd::MaskOf<T>& torn = simd::MaskOf<T>{}) {
  const T none{}, one = none + 1.0;
  const Triple<T> gap = jump - at.start;
  const PartsOfStretch<T> begun = parts_of_stretch<T>(law, at.plane, at.offset);
  const Triple<T> pressed = gap + begun.pressed;
  T damage = at.damage, drawn = at.drawn;
  simd::MaskOf<T> separated{}, opens{};
  const simd::MaskOf<T> may = grows & law.softens & simd::below(at.damage, one);
  if (simd::any(may)) {
    const Triple<T> whole = gap + at.offset;
    const T open = dot(whole, at.plane);
    const Triple<T> along = whole - open * at.plane;
    const T shear = root(dot(along, along)), drive = strength_ratio<T>(law, open, shear);
    const StrengthLeft<T> left = strength_left<T>(law, open, shear, drive < one ? one : drive);
    const T before = one - at.damage;
    T ratio = strength_ratio<T>(law, at.plane, pressed + at.drawn * begun.bonded);
    const simd::MaskOf<T> advances = may & (torn | simd::below<T>(left.part, before * ratio));
    if (simd::any(advances)) {
      const simd::MaskOf<T> onwards = simd::below<T>(none, dot(gap, begun.bonded));
      const T begun_ratio = strength_ratio<T>(law, at.plane, begun.bonded),
              fading = onwards ? 4.0 * begun_ratio : none;
      T part = one, fades = at.drawn; // of lambda, a
      for (int i = 0; i < cohesive_iterations; ++i) {
        const T excess = before * part * ratio - left.part, slope = before * (ratio + fading * fades);
        const T next = part - (advances ? excess : none) / (advances ? slope : one);
        part = next < none ? none : next;
        fades = onwards ? at.drawn * fourth_power<T>(part) : at.drawn;
        ratio = strength_ratio<T>(law, at.plane, pressed + fades * begun.bonded);
      }
      const simd::MaskOf<T> ends = torn | simd::at_most(left.part, none);
      damage = advances ? (ends ? one : one - before * part) : damage;
      drawn = advances ? (ends ? none : fades) : drawn;
      separated = advances & ends;
      opens = torn | left.opens;
    }
  }
  const SpringResponseOf<T> contact =
      contact_response<T>(law.kn, law.ks, law.tan_friction, at.plane, pressed, at.slip);
  const Triple<T> stretch = pressed + drawn * begun.bonded,
                  across = ((one - damage) * law.kn) * stretch + damage * contact.traction;
  return {at.plane.z * across + (one - damage) * at.rest,
          across,
          contact.traction,
          contact.offset,
          stretch,
          damage,
          drawn,
          separated,
          opens};
}

// J per area, across the plane: what the springs store, less what they stored when the crack began, which the body never did.
// Of that, the part of w_c fades with the law's own; the rest, of pressure and friction, goes with the last of the strength, as
// D^32: where damage takes most per D. So a face that has lost its strength stores what its contact stores, and what breaking
// takes grows all along. A brittle face loses its strength at once; its springs keep the part of w_f until it parts. One that was
// broken by hand draws nothing (a = 0) and stores what its contact stores.
template <class T>
CDEM_INLINE T stored_across(const SofteningLawOf<T>& law, const CohesivePoint<T>& at,
                            const CohesiveResponse<T>& now) {
  const PartsOfStretch<T> begun = parts_of_stretch<T>(law, at.plane, at.offset);
  const T rubbing = dot(now.contact, now.contact) / (law.kn * law.kn),
          bonded = dot(begun.bonded, begun.bonded), pressed = dot(begun.pressed, begun.pressed),
          both = dot(at.offset, at.offset) - bonded - pressed, fourth = fourth_power<T>(now.damage),
          late = law.softens ? fourth_power<T>(fourth * fourth) : 1.0 - now.drawn;
  return 0.5 * law.kn *
         ((1.0 - now.damage) * (dot(now.stretch, now.stretch) - now.drawn * now.drawn * bonded) +
          now.damage * rubbing - (1.0 - late) * pressed - (1.0 - (law.softens ? late : now.damage)) * both);
}

// J per area of the face. r0 stores (1 - D) r0.j.
template <class T>
CDEM_INLINE T cohesive_stored(const SofteningLawOf<T>& law, const CohesivePoint<T>& at, const Triple<T>& jump,
                              const CohesiveResponse<T>& now) {
  return at.plane.z * stored_across<T>(law, at, now) + (1.0 - now.damage) * dot(at.rest, jump - at.start);
}

// What a step from the relative displacement gap0 to gap1 lost, across the plane: work by the trapezoidal rule less the
// change of what is stored. Friction is the work of t_c over the growth of D slip.
template <class T>
CDEM_INLINE SofteningLoss<T> cohesive_loss(const SofteningLawOf<T>& law, const CohesivePoint<T>& at,
                                           const Triple<T>& gap0, const Triple<T>& gap1,
                                           const CohesiveResponse<T>& now) {
  const CohesiveResponse<T> before = cohesive_response<T>(law, at, gap0, simd::MaskOf<T>{});
  SofteningLoss<T> loss;
  loss.friction = 0.5 * dot(before.contact + now.contact, now.damage * now.slip - at.damage * before.slip);
  loss.breaking = 0.5 * dot(before.across + now.across, gap1 - gap0) -
                  (stored_across<T>(law, at, now) - stored_across<T>(law, at, before)) - loss.friction;
  return loss;
}

} // namespace cdem
