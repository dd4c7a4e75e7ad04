#include "libcdem/element/small_strain.hpp"

#include "libcdem/parallel/simd.hpp"

namespace cdem {
namespace {

CDEM_INLINE void small_strain_kernel(const TetBatch* batches, std::int64_t count, const Node* displacement,
                                     Node* force, ReadAhead& reads) {
  using simd::Oct;
  ReadAhead ahead = reads;
  for (std::int64_t i = 0; i < count; ++i) {
    const TetBatch& batch = batches[i];
    const simd::Vec u0 = simd::gather(displacement, batch.node[0]);
    Oct h[3][3] = {}; // grad u
    for (int k = 0; k < 3; ++k) {
      const simd::Vec u = simd::gather(displacement, batch.node[k + 1]);
      const Oct dx = u.x - u0.x, dy = u.y - u0.y, dz = u.z - u0.z;
      for (int axis = 0; axis < 3; ++axis) {
        const Oct g = simd::load(batch.grad[3 * k + axis]);
        h[0][axis] += dx * g;
        h[1][axis] += dy * g;
        h[2][axis] += dz * g;
      }
    }
    const Oct two_g = simd::load(batch.two_g_volume);
    const Oct pressure = simd::load(batch.lambda_volume) * (h[0][0] + h[1][1] + h[2][2]);
    const Oct xx = pressure + two_g * h[0][0], yy = pressure + two_g * h[1][1],
              zz = pressure + two_g * h[2][2];
    const Oct xy = 0.5 * two_g * (h[0][1] + h[1][0]);
    const Oct yz = 0.5 * two_g * (h[1][2] + h[2][1]);
    const Oct xz = 0.5 * two_g * (h[0][2] + h[2][0]);
    simd::Vec f0{};
    for (int k = 0; k < 3; ++k) {
      const Oct gx = simd::load(batch.grad[3 * k]), gy = simd::load(batch.grad[3 * k + 1]),
                gz = simd::load(batch.grad[3 * k + 2]);
      const simd::Vec f{-(xx * gx + xy * gy + xz * gz), -(xy * gx + yy * gy + yz * gz),
                        -(xz * gx + yz * gy + zz * gz)};
      f0.x -= f.x;
      f0.y -= f.y;
      f0.z -= f.z;
      simd::scatter_add(force, batch.node[k + 1], f);
    }
    simd::scatter_add(force, batch.node[0], f0);
    ahead.some();
  }
}

} // namespace

void add_small_strain_forces(const TetBatch* batches, std::int64_t count, const Node* displacement,
                             Node* force, ReadAhead ahead) {
  simd::best<small_strain_kernel>(batches, count, displacement, force, ahead);
}

} // namespace cdem
