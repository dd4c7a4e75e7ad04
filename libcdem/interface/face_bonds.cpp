#include "libcdem/interface/face_bonds.hpp"

#include "libcdem/parallel/simd.hpp"

#include <algorithm>
#include <cmath>
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

struct Response {
  geom::Vec3 force = geom::Vec3::Zero(); // N, on side a
  double energy = 0;                     // J
};

Response stretched(double kn, double ks, const geom::Vec3& normal, double open, const geom::Vec3& shear) {
  return {kn * open * normal + ks * shear, 0.5 * (kn * open * open + ks * shear.squaredNorm())};
}

// The contact a broken spring is. slip: turned into the face's plane, and moved on where it slides; the energy that
// sliding takes is added to `friction`.
Response contact(double kn, double ks, double tan_friction, const geom::Vec3& normal, const geom::Vec3& gap,
                 geom::Vec3& slip, double& friction) {
  const double open = gap.dot(normal);
  const geom::Vec3 tangential = gap - open * normal;
  if (open > 0) {
    slip = tangential;
    return {};
  }
  slip -= slip.dot(normal) * normal;
  geom::Vec3 shear = tangential - slip;
  const double trial = ks * shear.norm(), limit = -kn * open * tan_friction;
  if (trial > limit) {
    const double scale = limit / trial;
    slip += (1 - scale) * shear;
    friction += limit * (1 - scale) * shear.norm();
    shear *= scale;
  }
  return stretched(kn, ks, normal, open, shear);
}

geom::Vec3 lane_of(const Vec& v, int lane) {
  return {v.x[lane], v.y[lane], v.z[lane]};
}

void set_lane(Vec& v, int lane, const geom::Vec3& value) {
  v.x[lane] = value.x();
  v.y[lane] = value.y();
  v.z[lane] = value.z();
}

BondMode due(const FaceLaw& law, double area, double normal_force, double shear_force) {
  if (normal_force > law.tensile_strength * area)
    return BondMode::broken_tension;
  if (shear_force > std::max(0.0, law.cohesion * area - normal_force * law.tan_friction))
    return BondMode::broken_shear;
  return BondMode::intact;
}

// The springs of a batch some of which are broken or may break now, one by one: replaces their force on side a.
__attribute__((noinline)) void one_by_one(const FaceBatch& batch, int faces, const Points& p,
                                          const FaceLaw& law, bool breaking, std::int64_t first_spring,
                                          FaceStateBatch& state, Vec (&force)[3], FaceSums& sums) {
  for (int point = 0; point < 3; ++point)
    for (int lane = 0; lane < faces; ++lane) {
      const geom::Vec3 gap = lane_of(p.gap[point], lane), normal = lane_of(p.normal, lane).normalized();
      const double kn = batch.kn[lane], ks = law.shear_ratio * kn, area = batch.area[lane];
      std::uint8_t& mode = state.mode[point][lane];
      const bool was_intact = mode == static_cast<std::uint8_t>(BondMode::intact);
      double before = 0;
      if (was_intact) {
        if (!breaking)
          continue;
        const double open = gap.dot(normal);
        const geom::Vec3 shear = gap - open * normal;
        const BondMode now = due(law, area, kn * open, ks * shear.norm());
        if (now == BondMode::intact)
          continue;
        mode = static_cast<std::uint8_t>(now);
        for (double(&axis)[lanes] : state.slip[point])
          axis[lane] = 0;
        before = stretched(kn, ks, normal, open, shear).energy;
        sums.broken.push_back(
            {first_spring + point * lanes + lane, now, normal, kn * open / area, ks * shear.norm() / area});
      }
      geom::Vec3 slip(state.slip[point][0][lane], state.slip[point][1][lane], state.slip[point][2][lane]);
      double slid = 0;
      const Response r = contact(kn, ks, law.tan_friction, normal, gap, slip, slid);
      if (was_intact)
        sums.breaking += before - r.energy;
      else
        sums.friction += slid;
      for (int axis = 0; axis < 3; ++axis)
        state.slip[point][axis][lane] = slip[axis];
      set_lane(force[point], lane, r.force);
    }
}

} // namespace

// Batches by which reading runs ahead.
constexpr int ahead = 3;

// The kernel is compiled for several instruction sets; everything it calls on the way of intact bonds is inlined.
CDEM_KERNEL void face_bond_forces(const FaceBatch* batches, std::int64_t count, int faces,
                                  const Node* position, const Node* displacement, const FaceLaw& law,
                                  bool breaking, FaceStateBatch* state, Node* total, FaceSums& sums) {
  for (std::int64_t i = 0; i < count; ++i) {
    const FaceBatch& batch = batches[i];
    simd::prefetch(batches + i + ahead, offsetof(FaceBatch, node_a));
    simd::prefetch(state[i + ahead].mode, sizeof state->mode);
    const Points p = points_of(batch.place_a, batch.place_b, position, displacement);
    const Oct kn = simd::load(batch.kn), ks = law.shear_ratio * kn;
    const Oct difference = (kn - ks) / dot(p.normal, p.normal);
    Vec force[3];
    for (int point = 0; point < 3; ++point)
      force[point] =
          plus(scaled(ks, p.gap[point]), scaled(difference * dot(p.gap[point], p.normal), p.normal));
    if (!all_intact(state[i]) || (breaking && near_strength(batch, p, law))) {
      const Points copy = p; // what is handed on by reference does not stay in registers
      Vec changed[3] = {force[0], force[1], force[2]};
      one_by_one(batch, static_cast<int>(std::min<std::int64_t>(lanes, faces - i * lanes)), copy, law,
                 breaking, i * 3 * lanes, state[i], changed, sums);
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

FaceSpring face_spring(const FaceBatch& batch, int point, int lane, const Node* position,
                       const Node* displacement, const FaceLaw& law, const FaceStateBatch& state) {
  const Points p = points_of(batch.node_a, batch.node_b, position, displacement);
  FaceSpring spring;
  spring.gap = lane_of(p.gap[point], lane);
  spring.normal = lane_of(p.normal, lane).normalized();
  const double kn = batch.kn[lane], ks = law.shear_ratio * kn;
  Response r;
  if (state.mode[point][lane] == static_cast<std::uint8_t>(BondMode::intact)) {
    const double open = spring.gap.dot(spring.normal);
    r = stretched(kn, ks, spring.normal, open, spring.gap - open * spring.normal);
  } else {
    geom::Vec3 slip(state.slip[point][0][lane], state.slip[point][1][lane], state.slip[point][2][lane]);
    double slid = 0;
    r = contact(kn, ks, law.tan_friction, spring.normal, spring.gap, slip, slid);
  }
  spring.force = r.force;
  spring.energy = r.energy;
  return spring;
}

} // namespace cdem
