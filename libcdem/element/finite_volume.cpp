#include "libcdem/element/finite_volume.hpp"

#include "libcdem/parallel/simd.hpp"

namespace cdem {
namespace {

using simd::Oct;
using simd::Vec;

// Twice the area vectors of the faces opposite to corners 1, 2 and 3, inward: 6 V grad of their shape functions.
struct AreaVectors {
  Vec c1, c2, c3;
};

CDEM_INLINE AreaVectors area_vectors(const Vec& e1, const Vec& e2, const Vec& e3) {
  return {cross(e2, e3), cross(e3, e1), cross(e1, e2)};
}

struct Symmetric {
  Oct xx, yy, zz, xy, yz, xz;
};

CDEM_INLINE Vec corner_force(const Symmetric& s, const Vec& c) {
  constexpr double sixth = -1.0 / 6;
  return {sixth * (s.xx * c.x + s.xy * c.y + s.xz * c.z), sixth * (s.xy * c.x + s.yy * c.y + s.yz * c.z),
          sixth * (s.xz * c.x + s.yz * c.y + s.zz * c.z)};
}

} // namespace

TetStiffness tet_stiffness(const Elastic& material) {
  return {material.lame_lambda(), 2 * material.shear_modulus()};
}

// The kernel is compiled for several instruction sets; everything it calls is inlined into each of them.
CDEM_KERNEL double finite_volume_forces(const MeshBatch* batches, std::int64_t count, int last_lanes,
                                        const Node* position, const Node* velocity, double dt,
                                        const TetStiffness& stiffness, const TetDamping& damping,
                                        StressBatch* stress, Node* force, ReadAhead& ahead) {
  const double rate = dt > 0 ? damping.beta / dt : 0;
  Oct damped{};
  const Oct half_dt = Oct{} + 0.5 * dt;
  for (std::int64_t i = 0; i < count; ++i) {
    const MeshBatch& batch = batches[i];
    ahead.some();
    Oct lambda = Oct{} + stiffness.lambda, two_g = Oct{} + stiffness.two_g;
    if (i + 1 == count)
      for (int lane = last_lanes; lane < lanes; ++lane)
        lambda[lane] = two_g[lane] = 0;

    const Vec x0 = simd::gather(position, batch.place[0]), v0 = simd::gather(velocity, batch.place[0]);
    const Vec e1 = minus(simd::gather(position, batch.place[1]), x0);
    const Vec e2 = minus(simd::gather(position, batch.place[2]), x0);
    const Vec e3 = minus(simd::gather(position, batch.place[3]), x0);
    const Vec v1 = minus(simd::gather(velocity, batch.place[1]), v0);
    const Vec v2 = minus(simd::gather(velocity, batch.place[2]), v0);
    const Vec v3 = minus(simd::gather(velocity, batch.place[3]), v0);

    // dt grad v in the middle of the step.
    const Vec m1 = minus(e1, scaled(half_dt, v1)), m2 = minus(e2, scaled(half_dt, v2)),
              m3 = minus(e3, scaled(half_dt, v3));
    const AreaVectors middle = area_vectors(m1, m2, m3);
    const Oct scale = dt / dot(m1, middle.c1);
    const Vec a1 = scaled(scale, middle.c1), a2 = scaled(scale, middle.c2), a3 = scaled(scale, middle.c3);
    const Oct xx = v1.x * a1.x + v2.x * a2.x + v3.x * a3.x, xy = v1.x * a1.y + v2.x * a2.y + v3.x * a3.y,
              xz = v1.x * a1.z + v2.x * a2.z + v3.x * a3.z;
    const Oct yx = v1.y * a1.x + v2.y * a2.x + v3.y * a3.x, yy = v1.y * a1.y + v2.y * a2.y + v3.y * a3.y,
              yz = v1.y * a1.z + v2.y * a2.z + v3.y * a3.z;
    const Oct zx = v1.z * a1.x + v2.z * a2.x + v3.z * a3.x, zy = v1.z * a1.y + v2.z * a2.y + v3.z * a3.y,
              zz = v1.z * a1.z + v2.z * a2.z + v3.z * a3.z;

    // W r = w x r; Q - I = s (W + W^2 / 2), W^2 = w w^T - |w|^2 I.
    const Oct wx = 0.5 * (zy - yz), wy = 0.5 * (xz - zx), wz = 0.5 * (yx - xy);
    const Oct w2 = wx * wx + wy * wy + wz * wz;
    const Oct s = 1.0 / (1.0 + 0.25 * w2), h = 0.5 * s;
    const Oct qxx = 1.0 + h * (wx * wx - w2), qyy = 1.0 + h * (wy * wy - w2), qzz = 1.0 + h * (wz * wz - w2);
    const Oct pxy = h * wx * wy, pyz = h * wy * wz, pxz = h * wx * wz;
    const Oct sx = s * wx, sy = s * wy, sz = s * wz;
    const Oct qxy = pxy - sz, qyx = pxy + sz, qxz = pxz + sy, qzx = pxz - sy, qyz = pyz - sx, qzy = pyz + sx;

    StressBatch& t = stress[i];
    const Oct txx = simd::load(t.component[0]), tyy = simd::load(t.component[1]),
              tzz = simd::load(t.component[2]), txy = simd::load(t.component[3]),
              tyz = simd::load(t.component[4]), txz = simd::load(t.component[5]);
    // Q sigma, row by row
    const Oct bxx = qxx * txx + qxy * txy + qxz * txz, bxy = qxx * txy + qxy * tyy + qxz * tyz,
              bxz = qxx * txz + qxy * tyz + qxz * tzz;
    const Oct byx = qyx * txx + qyy * txy + qyz * txz, byy = qyx * txy + qyy * tyy + qyz * tyz,
              byz = qyx * txz + qyy * tyz + qyz * tzz;
    const Oct bzx = qzx * txx + qzy * txy + qzz * txz, bzy = qzx * txy + qzy * tyy + qzz * tyz,
              bzz = qzx * txz + qzy * tyz + qzz * tzz;
    const Oct pressure = lambda * (xx + yy + zz), g = 0.5 * two_g;
    const Oct rxx = bxx * qxx + bxy * qxy + bxz * qxz + pressure + two_g * xx;
    const Oct ryy = byx * qyx + byy * qyy + byz * qyz + pressure + two_g * yy;
    const Oct rzz = bzx * qzx + bzy * qzy + bzz * qzz + pressure + two_g * zz;
    const Oct rxy = bxx * qyx + bxy * qyy + bxz * qyz + g * (xy + yx);
    const Oct ryz = byx * qzx + byy * qzy + byz * qzz + g * (yz + zy);
    const Oct rxz = bxx * qzx + bxy * qzy + bxz * qzz + g * (xz + zx);
    simd::store(t.component[0], rxx);
    simd::store(t.component[1], ryy);
    simd::store(t.component[2], rzz);
    simd::store(t.component[3], rxy);
    simd::store(t.component[4], ryz);
    simd::store(t.component[5], rxz);

    Symmetric r{rxx, ryy, rzz, rxy, ryz, rxz};
    if (damping.viscous) {
      StressBatch& kept = damping.viscous[i];
      const Symmetric before{simd::load(kept.component[0]), simd::load(kept.component[1]),
                             simd::load(kept.component[2]), simd::load(kept.component[3]),
                             simd::load(kept.component[4]), simd::load(kept.component[5])};
      Symmetric now = before;
      if (dt > 0) {
        now = {rate * (pressure + two_g * xx), rate * (pressure + two_g * yy), rate * (pressure + two_g * zz),
               rate * g * (xy + yx),           rate * g * (yz + zy),           rate * g * (xz + zx)};
        const Oct half_volume = dot(m1, middle.c1) / 12;
        damped += half_volume * ((before.xx + now.xx) * xx + (before.yy + now.yy) * yy +
                                 (before.zz + now.zz) * zz + (before.xy + now.xy) * (xy + yx) +
                                 (before.yz + now.yz) * (yz + zy) + (before.xz + now.xz) * (xz + zx));
        simd::store(kept.component[0], now.xx);
        simd::store(kept.component[1], now.yy);
        simd::store(kept.component[2], now.zz);
        simd::store(kept.component[3], now.xy);
        simd::store(kept.component[4], now.yz);
        simd::store(kept.component[5], now.xz);
      }
      r = {rxx + now.xx, ryy + now.yy, rzz + now.zz, rxy + now.xy, ryz + now.yz, rxz + now.xz};
    }

    const AreaVectors end = area_vectors(e1, e2, e3);
    const Vec f1 = corner_force(r, end.c1), f2 = corner_force(r, end.c2), f3 = corner_force(r, end.c3);
    const Vec f0{-(f1.x + f2.x + f3.x), -(f1.y + f2.y + f3.y), -(f1.z + f2.z + f3.z)};
    simd::scatter_add(force, batch.place[0], f0);
    simd::scatter_add(force, batch.place[1], f1);
    simd::scatter_add(force, batch.place[2], f2);
    simd::scatter_add(force, batch.place[3], f3);
  }
  double sum = 0;
  for (int lane = 0; lane < lanes; ++lane)
    sum += damped[lane];
  return sum;
}

} // namespace cdem
