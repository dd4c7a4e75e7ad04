#include "libcdem/interface/broken_faces.hpp"

#include <algorithm>
#include <cstddef>

namespace cdem {
namespace {

using simd::Oct;
using simd::Vec;

struct Points {
  Vec gap[3];
  Vec normal; // not made a unit vector: four times the area
};

// Both sides of a face were one place: the gap is the difference of their displacements, with all its digits, and the
// corners of b stand where those of a do plus the gap.
template <class Index>
CDEM_INLINE Points points_of(const Index (&a)[3][lanes], const Index (&b)[3][lanes], const Node* position,
                             const Node* displacement) {
  const Vec d0 = minus(simd::gather(displacement, b[0]), simd::gather(displacement, a[0]));
  const Vec d1 = minus(simd::gather(displacement, b[1]), simd::gather(displacement, a[1]));
  const Vec d2 = minus(simd::gather(displacement, b[2]), simd::gather(displacement, a[2]));
  const Vec a0 = simd::gather(position, a[0]);
  const Vec e1 = minus(simd::gather(position, a[1]), a0);
  const Vec e2 = minus(simd::gather(position, a[2]), a0);
  Points p;
  p.normal = plus(cross(e1, e2), cross(plus(e1, minus(d1, d0)), plus(e2, minus(d2, d0))));
  const Oct sixth = Oct{} + 1.0 / 6, half = Oct{} + 0.5;
  const Vec common = scaled(sixth, plus(plus(d0, d1), d2));
  p.gap[0] = plus(common, scaled(half, d0));
  p.gap[1] = plus(common, scaled(half, d1));
  p.gap[2] = plus(common, scaled(half, d2));
  return p;
}

CDEM_INLINE bool all_intact(const FaceStateBatch& state) {
  static_assert(static_cast<int>(BondMode::intact) == 0 && lanes == 8);
  std::uint64_t modes[3];
  std::memcpy(modes, state.mode, sizeof modes);
  return (modes[0] | modes[1] | modes[2]) == 0;
}

using Mask = decltype(Oct{} < Oct{});

CDEM_INLINE bool any(const Mask& mask) {
  const auto four =
      __builtin_shufflevector(mask, mask, 0, 1, 2, 3) | __builtin_shufflevector(mask, mask, 4, 5, 6, 7);
  return (four[0] | four[1] | four[2] | four[3]) != 0;
}

// Some spring of the batch may be at its strength. Judged without roots: the length of the normal from the face's area,
// a unit vector to 1e-4 while strains stay under some per cent, and with a margin above that. break_if_due decides.
CDEM_INLINE bool near_strength(const FaceBatch& batch, const Points& p, const FaceLaw& law) {
  constexpr double margin = 0.98;
  const Oct area = simd::load(batch.area), kn = simd::load(batch.kn);
  const Oct guess = 1.0 / (12.0 * area);
  const Oct n2 = dot(p.normal, p.normal);
  const Oct once = guess * (1.5 - 0.5 * n2 * guess * guess);
  const Oct inverse = once * (1.5 - 0.5 * n2 * once * once); // 1 / |n|, by Newton
  const Oct tension = (margin * law.tensile_strength) * area, cohesion = (margin * law.cohesion) * area;
  Mask near{};
  for (int i = 0; i < 3; ++i) {
    const Oct gn = dot(p.gap[i], p.normal) * inverse;
    const Oct g2 = dot(p.gap[i], p.gap[i]);
    const Oct fn = kn * gn;
    const Oct shear2 = (law.shear_ratio * law.shear_ratio) * kn * kn * (g2 - gn * gn);
    const Oct left =
        cohesion - margin * law.tan_friction * fn; // of the shear strength; negative: beyond the cone's tip
    near |= (fn >= tension) | (shear2 >= left * left) | (left <= Oct{});
  }
  return any(near);
}

} // namespace

// Batches by which reading runs ahead.
constexpr int ahead = 3;

// The kernel is compiled for several instruction sets; everything it calls on the way of intact bonds is inlined.
CDEM_KERNEL void face_bond_forces(const FaceBatch* batches, std::int64_t count, int faces,
                                  const FaceMotion& motion, const FaceLaw& law, bool breaking,
                                  FaceStateBatch* state, FaceSlip* slips, Node* total, FaceSums& sums) {
  const Node *const position = motion.position, *const displacement = motion.displacement;
  for (std::int64_t i = 0; i < count; ++i) {
    const FaceBatch& batch = batches[i];
    simd::prefetch(batches + i + ahead, offsetof(FaceBatch, node_a));
    simd::prefetch(state + i + ahead, sizeof *state);
    const Points p = points_of(batch.place_a, batch.place_b, position, displacement);
    const Oct kn = simd::load(batch.kn), ks = law.shear_ratio * kn;
    const Oct difference = (kn - ks) / dot(p.normal, p.normal);
    Vec force[3];
    for (int point = 0; point < 3; ++point)
      force[point] =
          plus(scaled(ks, p.gap[point]), scaled(difference * dot(p.gap[point], p.normal), p.normal));
    if (!all_intact(state[i]) || (breaking && near_strength(batch, p, law))) {
      // What is handed on by reference does not stay in registers.
      Vec changed[3] = {force[0], force[1], force[2]};
      one_by_one(batch, static_cast<int>(std::min<std::int64_t>(lanes, faces - i * lanes)), motion, law,
                 breaking, i * 3 * lanes, state[i], slips, changed, sums);
      for (int point = 0; point < 3; ++point)
        force[point] = changed[point];
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

} // namespace cdem
