// Faces of a mesh of which some springs have broken, eight side by side: the contact that a broken spring is (face_bonds.hpp).
// What happens seldom is left to broken_faces.hpp, face by face: springs that may break now, and faces that are handed over.
#pragma once

#include "libcdem/bond/face_frame.hpp"
#include "libcdem/joint/coulomb_friction.hpp"
#include "libcdem/parallel/simd.hpp"
#include "libcdem/parallel/triple.hpp"

#include <cstring>

namespace cdem {

// As FaceFrame, of eight faces.
struct EightFaces {
  simd::Vec gap[3];                // m, at the points
  simd::Vec normal, along, across; // unit
};

CDEM_INLINE simd::Vec unit_vector(const simd::Vec& v) {
  return simd::scaled(1.0 / root(simd::dot(v, v)), v);
}

// x: m, corners of side a; d: m, of the corners from a to b.
CDEM_INLINE EightFaces eight_faces(const simd::Vec (&x)[3], const simd::Vec (&d)[3]) {
  using namespace simd;
  const Vec e1 = minus(x[1], x[0]), e2 = minus(x[2], x[0]), d1 = minus(d[1], d[0]), d2 = minus(d[2], d[0]);
  const Oct half = Oct{} + 0.5, sixth = Oct{} + 1.0 / 6;
  EightFaces f;
  f.normal = unit_vector(plus(cross(e1, e2), cross(plus(e1, d1), plus(e2, d2))));
  const Vec edge = plus(e1, scaled(half, d1));
  f.along = unit_vector(minus(edge, scaled(dot(edge, f.normal), f.normal)));
  f.across = cross(f.normal, f.along);
  const Vec common = scaled(sixth, plus(plus(d[0], d[1]), d[2]));
  for (int k = 0; k < 3; ++k)
    f.gap[k] = plus(common, scaled(half, d[k]));
  return f;
}

CDEM_INLINE simd::Mask lanes_with(const std::uint8_t (&bytes)[lanes], std::uint8_t value) {
  simd::Mask mask{};
  for (int lane = 0; lane < lanes; ++lane)
    mask[lane] = bytes[lane] == value ? -1 : 0;
  return mask;
}

CDEM_INLINE unsigned bits_of(const simd::Mask& mask) {
  unsigned bits = 0;
  for (int lane = 0; lane < lanes; ++lane)
    bits |= static_cast<unsigned>(mask[lane] != 0) << lane;
  return bits;
}

// The places of a batch at the time `behind` ago, and the relative displacements of its corners then.
CDEM_INLINE void corners_of(const FaceBatch& batch, const FaceMotion& m, double behind, simd::Vec (&x)[3],
                            simd::Vec (&d)[3]) {
  const simd::Oct back = simd::Oct{} - behind;
  for (int k = 0; k < 3; ++k) {
    x[k] = simd::gather(m.position, batch.place_a[k]);
    d[k] = simd::minus(simd::gather(m.displacement, batch.place_b[k]),
                       simd::gather(m.displacement, batch.place_a[k]));
    if (behind == 0)
      continue;
    const simd::Vec v = simd::gather(m.velocity, batch.place_a[k]);
    x[k] = simd::plus(x[k], simd::scaled(back, v));
    d[k] = simd::plus(d[k], simd::scaled(back, simd::minus(simd::gather(m.velocity, batch.place_b[k]), v)));
  }
}

// Advances the broken springs of the faces of a batch and replaces their force on side a, N; `lane_by_lane`: faces that are
// left alone. slips: of the first face. Returns the faces that part or slide away and are to be handed over, a bit each.
CDEM_INLINE unsigned slide_eight(const FaceBatch& batch, const FaceMotion& motion, const FaceLaw& law,
                                 const simd::Oct& tan_friction, unsigned lane_by_lane,
                                 std::int64_t first_face, FaceStateBatch& state, FaceSlip* slips,
                                 simd::Vec (&force)[3], FaceSums& sums) {
  using namespace simd;
  const Oct zero{}, one = zero + 1.0;
  Vec x[3], d[3];
  corners_of(batch, motion, 0, x, d);
  const EightFaces now = eight_faces(x, d);
  const Oct kn = load(batch.kn), ks = law.shear_ratio * kn;
  Mask left{};
  for (int lane = 0; lane < lanes; ++lane)
    left[lane] = (lane_by_lane >> lane & 1u) != 0 ? -1 : 0;
  const Mask gone = lanes_with(state.handed_over, static_cast<std::uint8_t>(HandOver::done));
  Mask broken[3], all = ~left & ~gone;
  Oct from[3][2], slip[3][2], shear[3][2], opening[3];
  bool any_slips = false;
  for (int point = 0; point < 3; ++point) {
    broken[point] =
        ~lanes_with(state.mode[point], static_cast<std::uint8_t>(BondMode::intact)) & ~left & ~gone;
    all &= broken[point];
    for (int axis = 0; axis < 2; ++axis)
      for (int lane = 0; lane < lanes; ++lane)
        from[point][axis][lane] = slips[lane].value[point][axis];
    const Vec& gap = now.gap[point];
    const Oct along[2] = {dot(gap, now.along), dot(gap, now.across)};
    opening[point] = dot(gap, now.normal);
    const Mask open = opening[point] > 0.0;
    const Oct trial[2] = {ks * (along[0] - from[point][0]), ks * (along[1] - from[point][1])};
    const Oct size = root(trial[0] * trial[0] + trial[1] * trial[1]),
              limit = friction_limit<Oct>(-kn * opening[point], tan_friction);
    const Mask slides = ~open & (size > limit);
    const Oct too_much = (one - limit / (slides ? size : one)) / (slides ? ks : one);
    for (int axis = 0; axis < 2; ++axis) {
      slip[point][axis] = open     ? along[axis]
                          : slides ? from[point][axis] + too_much * trial[axis]
                                   : from[point][axis];
      slip[point][axis] = broken[point] ? slip[point][axis] : from[point][axis];
      shear[point][axis] = open ? zero : ks * (along[axis] - slip[point][axis]);
    }
    any_slips = any_slips || any(broken[point] & (open | slides));
    const Oct pressed = open ? zero : kn * opening[point];
    const Vec pull = plus(scaled(pressed, now.normal),
                          plus(scaled(shear[point][0], now.along), scaled(shear[point][1], now.across)));
    Vec& f = force[point];
    f = {broken[point] ? pull.x : f.x, broken[point] ? pull.y : f.y, broken[point] ? pull.z : f.z};
    f = {gone ? zero : f.x, gone ? zero : f.y, gone ? zero : f.z};
  }
  if (any_slips) { // friction by the trapezoidal rule
    corners_of(batch, motion, motion.step, x, d);
    const EightFaces before = eight_faces(x, d);
    Oct lost{};
    for (int point = 0; point < 3; ++point) {
      const Vec& gap = before.gap[point];
      const Mask closed = ~(dot(gap, before.normal) > 0.0);
      const Oct along[2] = {dot(gap, before.along), dot(gap, before.across)};
      Oct here{};
      for (int axis = 0; axis < 2; ++axis) {
        const Oct held = closed ? ks * (along[axis] - from[point][axis]) : zero;
        here += 0.5 * (held + shear[point][axis]) * (slip[point][axis] - from[point][axis]);
        for (int lane = 0; lane < lanes; ++lane)
          slips[lane].value[point][axis] =
              broken[point][lane] != 0 ? slip[point][axis][lane] : slips[lane].value[point][axis];
      }
      lost += broken[point] ? here : zero;
    }
    for (int lane = 0; lane < lanes; ++lane)
      sums.friction += lost[lane];
  }
  // Faces without a whole bond.
  const Oct area = 3.0 * load(batch.area);
  if (!law.hands_over) {
    Mask astray{};
    for (int point = 0; point < 3; ++point)
      astray |= all & (opening[point] < 0.0) & (dot(now.gap[point], now.gap[point]) > area);
    if (any(astray))
      for (int lane = 0; lane < lanes; ++lane)
        sums.astray = astray[lane] != 0 ? first_face + lane : sums.astray;
    return 0;
  }
  if (!law.hand_over_due || !any(all))
    return 0;
  Mask apart = all, away = all;
  const Oct size = root(area);
  for (int point = 0; point < 3; ++point) {
    const Oct u = dot(now.gap[point], now.along), v = dot(now.gap[point], now.across);
    apart &= opening[point] > parted_from * size;
    away &= u * u + v * v > (slid_from * slid_from) * area;
  }
  for (int lane = 0; lane < lanes; ++lane)
    if (all[lane] != 0)
      come_loose(state, lane, sums);
  return bits_of(apart | away);
}

} // namespace cdem
