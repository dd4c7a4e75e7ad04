#include "libcdem/bond/broken_faces.hpp"
#include "libcdem/bond/sliding_faces.hpp"
#include "libcdem/joint/mohr_coulomb.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>

namespace cdem {
namespace {

using simd::Oct;
using simd::Vec;

struct Gaps {
  Vec corner[3], point[3]; // m, from a to b
};

template <class Index>
CDEM_INLINE Gaps gaps_of(const Index (&a)[3][lanes], const Index (&b)[3][lanes], const Node* displacement) {
  // Both sides of a face had one undeformed position: their relative displacement is the difference of their
  // displacements, with all its digits.
  const Vec d0 = minus(simd::gather(displacement, b[0]), simd::gather(displacement, a[0]));
  const Vec d1 = minus(simd::gather(displacement, b[1]), simd::gather(displacement, a[1]));
  const Vec d2 = minus(simd::gather(displacement, b[2]), simd::gather(displacement, a[2]));
  const Oct sixth = Oct{} + 1.0 / 6, half = Oct{} + 0.5;
  const Vec common = scaled(sixth, plus(plus(d0, d1), d2));
  return {{d0, d1, d2},
          {plus(common, scaled(half, d0)), plus(common, scaled(half, d1)), plus(common, scaled(half, d2))}};
}

// Not made a unit vector: four times the area. The corners of b are those of a plus the relative displacement.
template <class Index>
CDEM_INLINE Vec normal_of(const Index (&a)[3][lanes], const Vec (&d)[3], const Node* position) {
  const Vec a0 = simd::gather(position, a[0]);
  const Vec e1 = minus(simd::gather(position, a[1]), a0);
  const Vec e2 = minus(simd::gather(position, a[2]), a0);
  return plus(cross(e1, e2), cross(plus(e1, minus(d[1], d[0])), plus(e2, minus(d[2], d[0]))));
}

CDEM_INLINE bool all_intact(const FaceStateBatch& state) {
  static_assert(static_cast<int>(BondMode::intact) == 0 && lanes == 8);
  std::uint64_t modes[3];
  std::memcpy(modes, state.mode, sizeof modes);
  return (modes[0] | modes[1] | modes[2]) == 0;
}

CDEM_INLINE bool none_intact(const FaceStateBatch& state) {
  std::uint64_t modes[3];
  std::memcpy(modes, state.mode, sizeof modes);
  const auto without_zeros = [](std::uint64_t bytes) { // they are small numbers
    return ((bytes + 0x7f7f7f7f7f7f7f7fu) & 0x8080808080808080u) == 0x8080808080808080u;
  };
  return without_zeros(modes[0]) && without_zeros(modes[1]) && without_zeros(modes[2]);
}

CDEM_INLINE bool all_handed_over(const FaceStateBatch& state) {
  constexpr std::uint64_t done = 0x0101010101010101u * static_cast<std::uint64_t>(HandOver::done);
  std::uint64_t now = 0;
  std::memcpy(&now, state.handed_over, sizeof now);
  return now == done;
}

// Strengths of the faces of a batch.
struct Strengths {
  Oct tension, cohesion, tan_friction;
};

CDEM_INLINE Strengths strengths_of(const FaceLaw& law, std::int64_t batch) {
  if (!law.own)
    return {Oct{} + law.tensile_strength, Oct{} + law.cohesion, Oct{} + law.tan_friction};
  const FaceStrengthBatch& own = law.own[batch];
  return {simd::load(own.tensile_strength), simd::load(own.cohesion), simd::load(own.tan_friction)};
}

// Some spring of the batch carries a force that would break it in the worst of all directions, which is
// F = A min(T, C cos(phi)): a look that needs no normal.
CDEM_INLINE bool under_load(const FaceBatch& batch, const Gaps& gaps, const FaceLaw& law,
                            const Strengths& s) {
  const double part = unbreakable_part / std::max(1.0, law.shear_ratio);
  const Oct area = part * simd::load(batch.area), kn = simd::load(batch.kn), kn2 = kn * kn;
  const Oct tension2 = s.tension * s.tension,
            shear2 = s.cohesion * s.cohesion / (1.0 + s.tan_friction * s.tan_friction);
  const Oct most2 = (tension2 < shear2 ? tension2 : shear2) * area * area;
  for (const Vec& gap : gaps.point)
    if (simd::any_negative(most2 - kn2 * dot(gap, gap)))
      return true;
  return false;
}

// The faces of the batch of which some whole spring may be at its strength, a bit each. Judged without roots: the length of
// the normal from the face's area, a unit vector to 1e-4 while strains stay under some per cent, and with a margin above that.
template <class V, int first>
CDEM_INLINE unsigned near_strength(const FaceBatch& batch, const Gaps& gaps, const Vec& normals,
                                   const FaceLaw& law, const Strengths& s, const FaceStateBatch& state) {
  using simd::part_of;
  const V area = simd::load_wide<V>(batch.area + first), kn = simd::load_wide<V>(batch.kn + first);
  const simd::VecOf<V> normal = cdem::part_of<V, first>(normals);
  const V guess = 1.0 / (12.0 * area);
  const V n2 = dot(normal, normal);
  const V once = guess * (1.5 - 0.5 * n2 * guess * guess);
  const V inverse = once * (1.5 - 0.5 * n2 * once * once); // 1 / |n|, by Newton
  const V tension = (unbreakable_part * part_of<V, first>(s.tension)) * area,
          cohesion = (unbreakable_part * part_of<V, first>(s.cohesion)) * area,
          tan_friction = unbreakable_part * part_of<V, first>(s.tan_friction);
  simd::MaskOf<V> near{};
  for (int point = 0; point < 3; ++point) {
    const simd::VecOf<V> gap = cdem::part_of<V, first>(gaps.point[point]);
    const V gn = dot(gap, normal) * inverse;
    const V g2 = dot(gap, gap);
    const V fn = kn * gn;
    const V shear2 = (law.shear_ratio * law.shear_ratio) * kn * kn * (g2 - gn * gn);
    const V left = shear_strength(cohesion, tan_friction, fn);
    near |= (simd::at_most<V>(tension, fn) | simd::at_most<V>(left * left, shear2) |
             simd::at_most<V>(left, V{})) &
            simd::lanes_with<V>(state.mode[point] + first, static_cast<std::uint8_t>(BondMode::intact));
  }
  return simd::bits_of(near) << first;
}

// f(0) of eight lanes, or f(0) and f(4) of four each: what each says of its faces, together.
template <class V, class F>
CDEM_INLINE unsigned in_parts(const F& f) {
  if constexpr (simd::width<V> == lanes)
    return f(std::integral_constant<int, 0>{});
  else
    return f(std::integral_constant<int, 0>{}) | f(std::integral_constant<int, 4>{});
}

// Batches by which reading runs ahead.
constexpr int batches_ahead = 3;

// All that it calls for intact bonds is inlined; one_by_one is not, and is the same code for every instruction set.
template <class V>
CDEM_INLINE void face_bond_kernel(const FaceBatch* batches, std::int64_t count, int faces,
                                  const FaceMotion& motion, const FaceLaw& law, bool breaking,
                                  FaceStateBatch* state, FaceSlipBatch* slips, Node* total, FaceSums& sums,
                                  ReadAhead& ahead) {
  const bool directed = law.shear_ratio != 1; // else the force lies along the gap
  for (std::int64_t i = 0; i < count; ++i) {
    const FaceBatch& batch = batches[i];
    ahead.some();
    if (all_handed_over(state[i]))
      continue;
    simd::prefetch(batches + i + batches_ahead, sizeof batch);
    simd::prefetch(state + i + batches_ahead, sizeof *state);
    const Gaps gaps = gaps_of(batch.place_a, batch.place_b, motion.displacement);
    const Oct kn = simd::load(batch.kn), ks = law.shear_ratio * kn;
    Vec force[3] = {scaled(ks, gaps.point[0]), scaled(ks, gaps.point[1]), scaled(ks, gaps.point[2])};
    unsigned may_break = 0;
    const Strengths strengths = strengths_of(law, i);
    const bool looks = breaking && !none_intact(state[i]) && under_load(batch, gaps, law, strengths);
    if (directed || looks) {
      const Vec normal = normal_of(batch.place_a, gaps.corner, motion.position);
      if (directed) {
        const Oct difference = (kn - ks) / dot(normal, normal);
        for (int point = 0; point < 3; ++point)
          force[point] = plus(force[point], scaled(difference * dot(gaps.point[point], normal), normal));
      }
      if (looks)
        may_break = in_parts<V>([&](auto part) __attribute__((always_inline)) {
          return near_strength<V, part>(batch, gaps, normal, law, strengths, state[i]);
        });
    }
    if (may_break != 0 || !all_intact(state[i])) {
      const unsigned used = (1u << std::min<std::int64_t>(lanes, faces - i * lanes)) - 1;
      FaceLaw here = law;
      if (law.own)
        here.own = law.own + i;
      unsigned lane_by_lane = may_break & used;
      if (state[i].slip >= 0) {
        for (int lane = 0; lane < lanes; ++lane)
          lane_by_lane = handed_over(state[i], lane) ? lane_by_lane & ~(1u << lane) : lane_by_lane;
        lane_by_lane |= in_parts<V>([&](auto part) __attribute__((always_inline)) {
          return slide<V, part>(batch, motion, here, strengths.tan_friction, lane_by_lane, i * lanes,
                                gaps.corner, gaps.point, state[i], breaking, slips[state[i].slip], force,
                                sums);
        });
      }
      if (lane_by_lane != 0) {
        // What is handed on by reference does not stay in registers.
        Vec changed[3] = {force[0], force[1], force[2]};
        one_by_one(batch, lane_by_lane, motion, here, breaking, i * 3 * lanes, state[i], slips, changed,
                   sums);
        for (int point = 0; point < 3; ++point)
          force[point] = changed[point];
      }
    }
    const Oct sixth = Oct{} + 1.0 / 6, half = Oct{} + 0.5;
    const Vec common = scaled(sixth, plus(plus(force[0], force[1]), force[2]));
    for (int corner = 0; corner < 3; ++corner) {
      const Vec f = plus(common, scaled(half, force[corner]));
      simd::scatter_add(total, batch.place_a[corner], f);
      simd::scatter_add(total, batch.place_b[corner], Vec{-f.x, -f.y, -f.z});
    }
  }
}

} // namespace

FaceLaw face_law(const Body& body) {
  return {body.bonding.shear_ratio, body.joint.tensile_strength, body.joint.cohesion,
          geom::portable::tan(body.joint.friction_angle)};
}

FaceLaw at_lane(const FaceLaw& law, int lane) {
  FaceLaw one = law;
  if (law.own) {
    one.tensile_strength = law.own->tensile_strength[lane];
    one.cohesion = law.own->cohesion[lane];
    one.tan_friction = law.own->tan_friction[lane];
  }
  one.own = nullptr;
  return one;
}

FaceLaw face_law(const Model& model, const MeshChunk& chunk, std::int64_t batch, int lane) {
  FaceLaw law = face_law(model.bodies[model.blocks[chunk.block].body]);
  if (!model.mesh.strength.empty())
    law.own = model.mesh.strength.data() + batch;
  return at_lane(law, lane);
}

void face_bond_forces(const FaceBatch* batches, std::int64_t count, int faces, const FaceMotion& motion,
                      const FaceLaw& law, bool breaking, FaceStateBatch* state, FaceSlipBatch* slips,
                      Node* total, FaceSums& sums, ReadAhead& ahead) {
  simd::best_width<face_bond_kernel<Oct>, face_bond_kernel<simd::Quad>>(
      batches, count, faces, motion, law, breaking, state, slips, total, sums, ahead);
  if (law.hands_over && law.hand_over_due)
    take_back(batches, faces, motion, state, sums, [&](int face, const FaceFrame& now) {
      FaceSlip slip; // where it stands it carries no shear
      for (int point = 0; point < 3; ++point)
        for (int axis = 0; axis < 2; ++axis)
          slip.value[point][axis] = now.in_axes(now.gap[point])[axis];
      slips[state[face / lanes].slip].set(face % lanes, slip);
    });
}

} // namespace cdem
