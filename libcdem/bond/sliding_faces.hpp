// Faces of a mesh of which some springs have broken, several side by side: the contact that a broken spring is (face_bonds.hpp).
// What happens seldom is left to broken_faces.hpp, face by face: springs that may break now, and faces that are handed over.
#pragma once

#include "libcdem/bond/leaving_faces.hpp"
#include "libcdem/joint/coulomb_friction.hpp"
#include "libcdem/parallel/simd.hpp"
#include "libcdem/parallel/triple.hpp"

#include <cstring>

namespace cdem {

// As FaceFrame, of several faces.
template <class V>
struct FramesOfFaces {
  simd::VecOf<V> normal, along, across; // unit
  simd::MaskOf<V> torn;                 // turned_away
};

template <class V>
CDEM_INLINE simd::VecOf<V> unit_vector(const simd::VecOf<V>& v) {
  return simd::scaled(1.0 / root(simd::dot(v, v)), v);
}

// x: m, corners of side a; d: m, of the corners from a to b.
template <class V>
CDEM_INLINE FramesOfFaces<V> frames_of_faces(const simd::VecOf<V> (&x)[3], const simd::VecOf<V> (&d)[3]) {
  using namespace simd;
  const VecOf<V> e1 = minus(x[1], x[0]), e2 = minus(x[2], x[0]), d1 = minus(d[1], d[0]),
                 d2 = minus(d[2], d[0]);
  const V half = V{} + 0.5;
  FramesOfFaces<V> f;
  const VecOf<V> edge_b = plus(e1, d1), normal_a = cross(e1, e2), normal_b = cross(edge_b, plus(e2, d2));
  f.torn = turned_away<V>(normal_a, normal_b, e1, edge_b);
  f.normal = unit_vector(plus(normal_a, normal_b));
  const VecOf<V> edge = plus(e1, scaled(half, d1));
  f.along = unit_vector(minus(edge, scaled(dot(edge, f.normal), f.normal)));
  f.across = cross(f.normal, f.along);
  return f;
}

template <class V, int first>
CDEM_INLINE simd::VecOf<V> part_of(const simd::Vec& v) {
  return {simd::part_of<V, first>(v.x), simd::part_of<V, first>(v.y), simd::part_of<V, first>(v.z)};
}

// Advances the broken springs of faces of a batch, from `first` on, and replaces their force on side a, N; `lane_by_lane`: faces of
// the batch that are left alone. corner, point: m, gaps there. slips: of the batch. Returns a bit each for faces that have torn, and,
// in steps in which they may leave, for those that have parted or slid away.
template <class V, int first>
CDEM_INLINE unsigned slide(const FaceBatch& batch, const FaceMotion& motion, const FaceLaw& law,
                           const simd::Oct& tan_of_all, unsigned lane_by_lane, std::int64_t first_face,
                           const simd::Vec (&corner)[3], const simd::Vec (&point_gap)[3],
                           const FaceStateBatch& state, bool breaking, FaceSlipBatch& slips,
                           simd::Vec (&force)[3], FaceSums& sums) {
  using namespace simd;
  using M = MaskOf<V>;
  constexpr int count = width<V>;
  const M left = lanes_of<V>(lane_by_lane >> first),
          gone = lanes_with<V>(state.handed_over + first, static_cast<std::uint8_t>(HandOver::done));
  M broken[3], all = ~left & ~gone, any_broken{};
  for (int point = 0; point < 3; ++point) {
    broken[point] = ~lanes_with<V>(state.mode[point] + first, static_cast<std::uint8_t>(BondMode::intact)) &
                    ~left & ~gone;
    all &= broken[point];
    any_broken |= broken[point];
  }
  const V zero{};
  const auto let_go_of_handed_over = [&](int point) __attribute__((always_inline)) {
    Vec& f = force[point];
    const auto part = [&](Oct & of) __attribute__((always_inline)) {
      set_part<V, first>(of, gone ? zero : simd::part_of<V, first>(of));
    };
    part(f.x);
    part(f.y);
    part(f.z);
  };
  if (!any(any_broken)) {
    if (any(gone))
      for (int point = 0; point < 3; ++point)
        let_go_of_handed_over(point);
    return 0;
  }
  const V one = zero + 1.0, tan_friction = simd::part_of<V, first>(tan_of_all),
          kn = load_wide<V>(batch.kn + first) * (one - load_wide<V>(state.let_go + first)),
          ks = law.shear_ratio * kn;
  VecOf<V> x[3], d[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = gather_wide<V>(motion.position, batch.place_a[k] + first);
    d[k] = cdem::part_of<V, first>(corner[k]);
  }
  const FramesOfFaces<V> now = frames_of_faces(x, d);
  V opening[3], along[3][2], lost{};
  for (int point = 0; point < 3; ++point) {
    const VecOf<V> gap = cdem::part_of<V, first>(point_gap[point]);
    along[point][0] = dot(gap, now.along);
    along[point][1] = dot(gap, now.across);
    opening[point] = dot(gap, now.normal);
    double(&kept)[2][lanes] = slips.value[point];
    double(&had)[2][lanes] = slips.shear[point];
    const V from[2] = {load_wide<V>(kept[0] + first), load_wide<V>(kept[1] + first)};
    const M open = below<V>(zero, opening[point]);
    const V trial[2] = {ks * (along[point][0] - from[0]), ks * (along[point][1] - from[1])};
    const V size = root(trial[0] * trial[0] + trial[1] * trial[1]),
            limit = friction_limit<V>(-kn * opening[point], tan_friction);
    const M slides = ~open & below<V>(limit, size);
    const V too_much = (one - limit / (slides ? size : one)) / (slides ? ks : one);
    V shear[2];
    for (int axis = 0; axis < 2; ++axis) {
      const V slid = from[axis] + too_much * trial[axis];
      V slip = open ? along[point][axis] : slides ? slid : from[axis];
      slip = broken[point] ? slip : from[axis];
      shear[axis] = open ? zero : ks * (along[point][axis] - slip);
      const V before = load_wide<V>(had[axis] + first);
      lost += 0.5 * (before + shear[axis]) * (slip - from[axis]); // friction by the trapezoidal rule
      store_wide<V>(kept[axis] + first, slip);
      store_wide<V>(had[axis] + first, broken[point] ? shear[axis] : before);
    }
    const V pressed = open ? zero : kn * opening[point];
    const VecOf<V> pull =
        plus(scaled(pressed, now.normal), plus(scaled(shear[0], now.along), scaled(shear[1], now.across)));
    Vec& f = force[point];
    const auto replace = [&](Oct & of, const V& by) __attribute__((always_inline)) {
      const V was = simd::part_of<V, first>(of);
      set_part<V, first>(of, gone ? zero : broken[point] ? by : was);
    };
    replace(f.x, pull.x);
    replace(f.y, pull.y);
    replace(f.z, pull.z);
  }
  for (int lane = 0; lane < count; ++lane)
    sums.friction += lost[lane];
  const unsigned torn = breaking ? bits_of(M(any_broken & ~all & now.torn)) << first : 0;
  // Faces without a whole bond.
  if (!any(all))
    return torn;
  const V area = 3.0 * load_wide<V>(batch.area + first);
  if (!law.hands_over) {
    M astray{};
    for (int point = 0; point < 3; ++point) {
      const VecOf<V> gap = cdem::part_of<V, first>(point_gap[point]);
      astray |= all & below<V>(opening[point], zero) & below<V>(area, dot(gap, gap));
    }
    if (any(astray))
      for (int lane = 0; lane < count; ++lane)
        sums.astray = astray[lane] != 0 ? first_face + first + lane : sums.astray;
    return torn;
  }
  if (!law.hand_over_due)
    return torn;
  M is_gone{};
  const V size = root(area);
  for (int point = 0; point < 3; ++point) {
    const V &u = along[point][0], &v = along[point][1];
    is_gone |= below<V>(parted_from * size, opening[point]) |
               below<V>((slid_from * slid_from) * area, u * u + v * v);
  }
  return torn | bits_of(M(all & is_gone)) << first;
}

} // namespace cdem
