// What one point of a cracking face carries and stores, per area (bond/cohesive_faces.hpp). Vectors stand in the face's own
// axes. T: double, or a vector of doubles for the points of several faces.
#pragma once

#include "libcdem/joint/softening.hpp"
#include "libcdem/state/cohesive_face.hpp"

namespace cdem {

// What a point remembers.
template <class T>
struct CohesivePoint {
  Triple<T> plane{};  // m, unit normal of the critical plane
  Triple<T> offset{}; // m, w0
  Triple<T> rest{};   // Pa, r0
  Triple<T> slip{};   // m, of the damaged part
  T damage{};         // D
};

template <class T>
CDEM_INLINE void set(T& to, int lane, double value) {
  if constexpr (std::is_same_v<T, double>)
    to = value;
  else
    to[lane] = value;
}

template <class T>
CDEM_INLINE void set(Triple<T>& to, int lane, const CohesiveFace::Vector& value) {
  set(to.x, lane, value[0]);
  set(to.y, lane, value[1]);
  set(to.z, lane, value[2]);
}

template <class T>
CDEM_INLINE void read_point(const CohesiveFace& face, int point, int lane, CohesivePoint<T>& at) {
  set(at.plane, lane, face.plane);
  set(at.offset, lane, face.offset[point]);
  set(at.rest, lane, face.rest[point]);
  set(at.slip, lane, face.slip[point]);
  set(at.damage, lane, face.damage[point]);
}

inline CohesivePoint<double> cohesive_point(const CohesiveFace& face, int point) {
  CohesivePoint<double> at;
  read_point(face, point, 0, at);
  return at;
}

template <class T>
struct CohesiveResponse {
  Triple<T> traction{}; // Pa, on side a
  SofteningResponse<T> law;
};

template <class T>
CDEM_INLINE CohesiveResponse<T> cohesive_response(const SofteningLawOf<T>& law, const CohesivePoint<T>& at,
                                                  const Triple<T>& gap, const simd::MaskOf<T>& grows) {
  CohesiveResponse<T> r;
  r.law = softening_response<T>(law, at.plane, gap + at.offset, at.damage, at.slip, grows & law.softens);
  r.traction = at.plane.z * r.law.traction + (1.0 - r.law.damage) * at.rest;
  return r;
}

// Energies of one point, J per area. The law begins stretched by w0 = offset (+ a gap of next to nothing), as if its spring
// had been drawn there: k w0^2 / 2, which the body never stored. Damage can take
//   P = k (<w0_n>^2 + <|w0_s| - friction>^2) / 2
// of it. The rest, of pressure and friction, goes with the last of the strength, as D^8: where damage takes most per D. So a
// face that has lost its strength stores what its contact stores, and what breaking takes grows all along. The springs of a
// brittle face, which loses its strength at once, keep this rest until it parts.
template <class T>
struct NeverStored {
  T all{}, by_damage{}; // k w0^2 / 2 and P
  simd::MaskOf<T> late{};

  CDEM_INLINE T left(const T& damage) const {
    const T none{}, d2 = damage * damage, d4 = d2 * d2;
    return all - damage * by_damage - (late ? d4 * d4 : none) * (all - by_damage);
  }
};

template <class T>
CDEM_INLINE NeverStored<T> never_stored(const SofteningLawOf<T>& law, const CohesivePoint<T>& at) {
  const T none{};
  const T open = dot(at.offset, at.plane);
  const Triple<T> along = at.offset - open * at.plane;
  const T shear = root(dot(along, along)), opening = none < open ? open : none;
  const T slipping = shear - friction_limit<T>(none < -open ? -open : none, law.tan_friction),
          slip = none < slipping ? slipping : none;
  return {0.5 * law.kn * dot(at.offset, at.offset), 0.5 * law.kn * (opening * opening + slip * slip),
          law.softens};
}

// r0 stores (1 - D) r0.j.
template <class T>
CDEM_INLINE T cohesive_stored(const SofteningLawOf<T>& law, const CohesivePoint<T>& at, const Triple<T>& gap,
                              const SofteningResponse<T>& now) {
  return at.plane.z * (softening_stored<T>(law, at.plane, gap + at.offset, now.damage, now.contact) -
                       never_stored<T>(law, at).left(now.damage)) +
         (1.0 - now.damage) * dot(at.rest, gap);
}

} // namespace cdem
