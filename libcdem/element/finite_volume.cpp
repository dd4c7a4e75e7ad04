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

CDEM_INLINE Symmetric load(const StressBatch& s) {
  return {simd::load(s.component[0]), simd::load(s.component[1]), simd::load(s.component[2]),
          simd::load(s.component[3]), simd::load(s.component[4]), simd::load(s.component[5])};
}

CDEM_INLINE void store(StressBatch& to, const Symmetric& s) {
  simd::store(to.component[0], s.xx);
  simd::store(to.component[1], s.yy);
  simd::store(to.component[2], s.zz);
  simd::store(to.component[3], s.xy);
  simd::store(to.component[4], s.yz);
  simd::store(to.component[5], s.xz);
}

CDEM_INLINE Symmetric plus(const Symmetric& a, const Symmetric& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.yz + b.yz, a.xz + b.xz};
}

CDEM_INLINE Symmetric scaled(double s, const Symmetric& a) {
  return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.yz, s * a.xz};
}

// A rotation, row by row.
struct Turn {
  Vec x, y, z;
};

// Q for the axial vector w of dt W: W r = w x r, Q - I = s (W + W^2 / 2), W^2 = w w^T - |w|^2 I.
CDEM_INLINE Turn turn_of(const Vec& w) {
  const Oct w2 = dot(w, w), s = 1.0 / (1.0 + 0.25 * w2), h = 0.5 * s;
  const Oct xy = h * w.x * w.y, yz = h * w.y * w.z, xz = h * w.x * w.z;
  const Vec sw = scaled(s, w);
  return {{1.0 + h * (w.x * w.x - w2), xy - sw.z, xz + sw.y},
          {xy + sw.z, 1.0 + h * (w.y * w.y - w2), yz - sw.x},
          {xz - sw.y, yz + sw.x, 1.0 + h * (w.z * w.z - w2)}};
}

// Q sigma Q^T
CDEM_INLINE Symmetric turned(const Turn& q, const Symmetric& s) {
  const auto row = [&](const Vec& r) {
    return Vec{r.x * s.xx + r.y * s.xy + r.z * s.xz, r.x * s.xy + r.y * s.yy + r.z * s.yz,
               r.x * s.xz + r.y * s.yz + r.z * s.zz};
  };
  const Vec x = row(q.x), y = row(q.y), z = row(q.z);
  return {dot(x, q.x), dot(y, q.y), dot(z, q.z), dot(x, q.y), dot(y, q.z), dot(x, q.z)};
}

CDEM_INLINE Vec corner_force(const Symmetric& s, const Vec& c) {
  constexpr double sixth = -1.0 / 6;
  return {sixth * (s.xx * c.x + s.xy * c.y + s.xz * c.z), sixth * (s.xy * c.x + s.yy * c.y + s.yz * c.z),
          sixth * (s.xz * c.x + s.yz * c.y + s.zz * c.z)};
}

struct Elastically {
  CDEM_INLINE void operator()(std::int64_t, const StressBatch&, const Oct&, Symmetric&) const {}
};

// Near the limit tets go one by one.
struct Plastically {
  PlasticTets tets;
  TetStiffness stiffness;
  const PlasticBound* bounds; // of all laws
  const RockLimit* peaks;     // of each law
  int count;                  // of the bounds

  CDEM_INLINE void operator()(std::int64_t batch, const StressBatch& before, const Oct& six_volume,
                              Symmetric& r) const {
    constexpr double third = 1.0 / 3;
    const Oct p = third * (r.xx + r.yy + r.zz), x = r.xx - p, y = r.yy - p, z = r.zz - p;
    const Oct j2 = 0.5 * (x * x + y * y + z * z) + r.xy * r.xy + r.yz * r.yz + r.xz * r.xz;
    const Oct zero{};
    unsigned near = 0; // a bit for each tet that may be beyond
    for (int i = 0; i < count; ++i) {
      const PlasticBound& b = bounds[i];
      const Oct shear = b.strength - b.slope * p, tension = b.tensile - p;
      const auto beyond = simd::at_most(shear, zero) | simd::at_most<Oct>(shear * shear, b.reach * j2) |
                          simd::at_most(tension, zero) |
                          simd::at_most<Oct>(tension * tension, (4 * third) * j2);
      for (int lane = 0; lane < lanes; ++lane)
        near |= beyond[lane] != 0 ? 1u << lane : 0u;
    }
    if (near != 0)
      yield(near, batch, before, six_volume, r);
  }
  void yield(unsigned near, std::int64_t batch, const StressBatch& before, const Oct& six_volume,
             Symmetric& r) const;
};

CDEM_INLINE Oct* component_of(Symmetric& s, int c) {
  Oct* const all[6] = {&s.xx, &s.yy, &s.zz, &s.xy, &s.yz, &s.xz};
  return all[c];
}

void Plastically::yield(unsigned near, std::int64_t batch, const StressBatch& before, const Oct& six_volume,
                        Symmetric& r) const {
  const std::int8_t* const law = tets.law + batch * lanes;
  for (int lane = 0; lane < lanes; ++lane) {
    if (law[lane] < 0 || (near >> lane & 1u) == 0)
      continue;
    double from[6], stress[6];
    for (int c = 0; c < 6; ++c) {
      from[c] = before.component[c][lane];
      stress[c] = (*component_of(r, c))[lane];
    }
    double& strain = tets.strain[batch].strain[lane];
    const Plasticity& rock = tets.laws->laws[law[lane]];
    const bool softens = rock.softening_strain > 0 && strain > 0;
    const double density = plastic_step(softens ? limit_at(rock, strain) : peaks[law[lane]], stiffness.lambda,
                                        0.5 * stiffness.two_g, from, stress, strain);
    *tets.work += density * six_volume[lane] / 6;
    for (int c = 0; c < 6; ++c)
      (*component_of(r, c))[lane] = stress[c];
  }
}

template <class Yield>
CDEM_INLINE double tets_kernel(const MeshBatch* batches, std::int64_t count, int last_lanes,
                               const Node* position, const Node* velocity, const JumpBatch* jumps, double dt,
                               const TetStiffness& stiffness, const TetDamping& damping, StressBatch* stress,
                               Node* force, ReadAhead& ahead, const Yield& yield) {
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

    const Turn turn = turn_of({0.5 * (zy - yz), 0.5 * (xz - zx), 0.5 * (yx - xy)});
    // Components of the strain; those off the diagonal are doubled.
    Symmetric strain{xx, yy, zz, xy + yx, yz + zy, xz + zx};
    if (jumps) {
      const JumpBatch& jump = jumps[i];
      const Oct once = 3.0 / dot(m1, middle.c1), twice = 2.0 * once; // 1 / 2V
      strain = {strain.xx + once * simd::load(jump.component[0]),
                strain.yy + once * simd::load(jump.component[1]),
                strain.zz + once * simd::load(jump.component[2]),
                strain.xy + twice * simd::load(jump.component[3]),
                strain.yz + twice * simd::load(jump.component[4]),
                strain.xz + twice * simd::load(jump.component[5])};
    }
    const Oct pressure = lambda * (strain.xx + strain.yy + strain.zz), g = 0.5 * two_g;
    const Symmetric increment{pressure + two_g * strain.xx,
                              pressure + two_g * strain.yy,
                              pressure + two_g * strain.zz,
                              g * strain.xy,
                              g * strain.yz,
                              g * strain.xz};
    const Symmetric half_increment = scaled(0.5, increment);
    StressBatch& kept_stress = stress[i];
    Symmetric r = plus(turned(turn, plus(load(kept_stress), half_increment)), half_increment);
    yield(i, kept_stress, dot(m1, middle.c1), r);
    store(kept_stress, r);
    if (damping.viscous) {
      StressBatch& kept = damping.viscous[i];
      const Symmetric before = load(kept);
      Symmetric now = before;
      if (dt > 0) {
        now = scaled(rate, increment);
        const Symmetric both = plus(before, now);
        const Oct half_volume = dot(m1, middle.c1) / 12;
        damped += half_volume * (both.xx * strain.xx + both.yy * strain.yy + both.zz * strain.zz +
                                 both.xy * strain.xy + both.yz * strain.yz + both.xz * strain.xz);
        store(kept, now);
      }
      r = plus(r, now);
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

CDEM_INLINE double finite_volume_kernel(const MeshBatch* batches, std::int64_t count, int last_lanes,
                                        const Node* position, const Node* velocity, const JumpBatch* jumps,
                                        double dt, const TetStiffness& stiffness, const TetDamping& damping,
                                        StressBatch* stress, Node* force, ReadAhead& ahead) {
  return tets_kernel(batches, count, last_lanes, position, velocity, jumps, dt, stiffness, damping, stress,
                     force, ahead, Elastically{});
}

CDEM_INLINE double plastic_kernel(const MeshBatch* batches, std::int64_t count, int last_lanes,
                                  const Node* position, const Node* velocity, const JumpBatch* jumps,
                                  double dt, const TetStiffness& stiffness, const TetDamping& damping,
                                  StressBatch* stress, Node* force, ReadAhead& ahead,
                                  const Plastically& plastically) {
  return tets_kernel(batches, count, last_lanes, position, velocity, jumps, dt, stiffness, damping, stress,
                     force, ahead, plastically);
}

} // namespace

TetStiffness tet_stiffness(const Elastic& material) {
  return {material.lame_lambda(), 2 * material.shear_modulus()};
}

double finite_volume_forces(const MeshBatch* batches, std::int64_t count, int last_lanes,
                            const Node* position, const Node* velocity, const JumpBatch* jumps, double dt,
                            const TetStiffness& stiffness, const TetDamping& damping,
                            const PlasticTets& plastic, StressBatch* stress, Node* force, ReadAhead& ahead) {
  if (plastic.laws && dt > 0) {
    thread_local std::vector<PlasticBound> bound;
    thread_local std::vector<RockLimit> peaks;
    bound.clear();
    peaks.clear();
    for (const Plasticity& law : plastic.laws->laws)
      peaks.push_back(limit_at(law, 0));
    for (const Plasticity& law : plastic.laws->laws)
      for (const PlasticBound& one : bounds(law))
        bound.push_back(one);
    return simd::best<plastic_kernel>(
        batches, count, last_lanes, position, velocity, jumps, dt, stiffness, damping, stress, force, ahead,
        Plastically{plastic, stiffness, bound.data(), peaks.data(), static_cast<int>(bound.size())});
  }
  return simd::best<finite_volume_kernel>(batches, count, last_lanes, position, velocity, jumps, dt,
                                          stiffness, damping, stress, force, ahead);
}

} // namespace cdem
