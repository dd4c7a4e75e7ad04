#include "libcdem/element/face_jumps.hpp"

#include "libcdem/parallel/simd.hpp"

namespace cdem {
namespace {

using simd::Oct;
using simd::Vec;

// 1: the sides hold together, 0: they crack or have parted, or the lane is empty.
CDEM_INLINE Oct holding(const FaceSideBatch& batch, const FaceStateBatch* faces) {
  Oct together{};
  for (int lane = 0; lane < lanes; ++lane) {
    const auto face = static_cast<std::uint32_t>(batch.face[lane]);
    const bool is_one = batch.face[lane] >= 0;
    together[lane] = is_one && holds(faces[face / lanes].stage[face % lanes]) ? 1 : 0;
  }
  return together;
}

// A n of the corners at x0, x1, x2.
CDEM_INLINE Vec area_vector(const Vec& x0, const Vec& x1, const Vec& x2) {
  return scaled(Oct{} + 0.5, cross(minus(x1, x0), minus(x2, x0)));
}

CDEM_INLINE void jump_kernel(const FaceSides& sides, const Node* position, const Node* velocity, double dt,
                             JumpBatch* jumps) {
  const Oct third = Oct{} + dt / 3, back = Oct{} + 0.5 * dt;
  for (std::int64_t i = 0; i < sides.count; ++i) {
    const FaceSideBatch& batch = sides.batches[i];
    Vec x[3], sum{};
    for (int corner = 0; corner < 3; ++corner) {
      const Vec v = simd::gather(velocity, batch.place[corner]);
      x[corner] = minus(simd::gather(position, batch.place[corner]), scaled(back, v));
      sum = plus(sum, minus(simd::gather(velocity, batch.beyond[corner]), v));
    }
    const Vec j = scaled(third * holding(batch, sides.faces), sum);
    const Vec n = area_vector(x[0], x[1], x[2]);
    const Oct half = Oct{} + 0.5;
    const Oct of[6] = {j.x * n.x,
                       j.y * n.y,
                       j.z * n.z,
                       half * (j.x * n.y + j.y * n.x),
                       half * (j.y * n.z + j.z * n.y),
                       half * (j.x * n.z + j.z * n.x)};
    // Seen from the other side, jump and normal have the other sign.
    for (int lane = 0; lane < lanes; ++lane)
      for (const int tet : {batch.tet[lane], batch.beyond_tet[lane]})
        if (tet >= 0)
          for (int c = 0; c < 6; ++c)
            jumps[tet / lanes].component[c][tet % lanes] += of[c][lane];
  }
}

CDEM_INLINE void side_force_kernel(const FaceSides& sides, const Node* position, const StressBatch* stress,
                                   const StressBatch* viscous, Node* force) {
  const Oct sixth = Oct{} + 1.0 / 6; // half the traction of each side, a third of it to each corner
  const auto stress_at = [&](int tet, int c) __attribute__((always_inline)) {
    return stress[tet / lanes].component[c][tet % lanes] +
           (viscous ? viscous[tet / lanes].component[c][tet % lanes] : 0);
  };
  for (std::int64_t i = 0; i < sides.count; ++i) {
    const FaceSideBatch& batch = sides.batches[i];
    Oct s[6];
    for (int c = 0; c < 6; ++c)
      for (int lane = 0; lane < lanes; ++lane)
        s[c][lane] = stress_at(batch.tet[lane], c) +
                     (batch.beyond_tet[lane] >= 0 ? stress_at(batch.beyond_tet[lane], c) : 0);
    const Vec n =
        scaled(sixth * holding(batch, sides.faces),
               area_vector(simd::gather(position, batch.place[0]), simd::gather(position, batch.place[1]),
                           simd::gather(position, batch.place[2])));
    const Vec f{s[0] * n.x + s[3] * n.y + s[5] * n.z, s[3] * n.x + s[1] * n.y + s[4] * n.z,
                s[5] * n.x + s[4] * n.y + s[2] * n.z};
    const Vec back{-f.x, -f.y, -f.z};
    for (int corner = 0; corner < 3; ++corner) {
      simd::scatter_add(force, batch.place[corner], f);
      simd::scatter_add(force, batch.beyond[corner], back);
    }
  }
}

} // namespace

void add_jumps(const FaceSides& sides, const Node* position, const Node* velocity, double dt,
               JumpBatch* jumps) {
  simd::best<jump_kernel>(sides, position, velocity, dt, jumps);
}

void add_side_forces(const FaceSides& sides, const Node* position, const StressBatch* stress,
                     const StressBatch* viscous, Node* force) {
  simd::best<side_force_kernel>(sides, position, stress, viscous, force);
}

} // namespace cdem
