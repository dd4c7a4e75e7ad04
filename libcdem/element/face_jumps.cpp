#include "libcdem/element/face_jumps.hpp"

#include "libcdem/parallel/simd.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace cdem {
namespace {

using simd::Oct;
using simd::Vec;

// One tet of a StressBatch or JumpBatch: faces ask for tets one by one.
struct alignas(64) TetRow {
  double component[lanes]; // six and two of zero
};

CDEM_INLINE Oct load(const TetRow& row) {
  return simd::load(row.component);
}

// Eight rows from six vectors, or the other way.
CDEM_INLINE void store_rows(const Oct (&of)[6], TetRow* rows) {
  Oct v[lanes] = {of[0], of[1], of[2], of[3], of[4], of[5], Oct{}, Oct{}};
  simd::transpose(v);
  for (int lane = 0; lane < lanes; ++lane)
    simd::store(rows[lane].component, v[lane]);
}

// 1: the sides hold together, 0: they crack or have parted, or the lane is empty. Without branches, which nothing could foretell.
using Held = std::uint8_t __attribute__((vector_size(lanes)));
CDEM_INLINE Held held(const FaceSideBatch& batch, const FaceStateBatch* faces) {
  Held together{};
  for (int lane = 0; lane < lanes; ++lane) {
    const auto face = static_cast<std::uint32_t>(std::max(batch.face[lane], 0));
    const bool is_one = batch.face[lane] >= 0, is_held = holds(faces[face / lanes].stage[face % lanes]);
    together[lane] = static_cast<std::uint8_t>(is_one & is_held);
  }
  return together;
}
CDEM_INLINE bool none(const Held& together) {
  std::uint64_t all;
  std::memcpy(&all, &together, sizeof all);
  return all == 0;
}

// A n of the corners at x0, x1, x2.
CDEM_INLINE Vec area_vector(const Vec& x0, const Vec& x1, const Vec& x2) {
  return scaled(Oct{} + 0.5, cross(minus(x1, x0), minus(x2, x0)));
}

// The last row takes what is beyond other chunks.
CDEM_INLINE void jump_kernel(const FaceSides& sides, const Node* position, const Node* velocity, double dt,
                             TetRow* rows, JumpBatch* jumps) {
  const std::int64_t tets = sides.tet_batches * lanes;
  for (std::int64_t i = 0; i <= tets; ++i)
    simd::store(rows[i].component, Oct{});
  const Oct third = Oct{} + dt / 3, back = Oct{} + 0.5 * dt;
  for (std::int64_t i = 0; i < sides.count; ++i) {
    const FaceSideBatch& batch = sides.batches[i];
    const Held together = held(batch, sides.faces);
    if (none(together))
      continue;
    Vec x[3], sum{};
    for (int corner = 0; corner < 3; ++corner) {
      const Vec v = simd::gather(velocity, batch.place[corner]);
      x[corner] = minus(simd::gather(position, batch.place[corner]), scaled(back, v));
      sum = plus(sum, minus(simd::gather(velocity, batch.beyond[corner]), v));
    }
    const Vec j = scaled(third * __builtin_convertvector(together, Oct), sum);
    const Vec n = area_vector(x[0], x[1], x[2]);
    const Oct half = Oct{} + 0.5;
    const Oct of[6] = {j.x * n.x,
                       j.y * n.y,
                       j.z * n.z,
                       half * (j.x * n.y + j.y * n.x),
                       half * (j.y * n.z + j.z * n.y),
                       half * (j.x * n.z + j.z * n.x)};
    TetRow of_faces[lanes];
    store_rows(of, of_faces);
    // Seen from the other side, jump and normal have the other sign.
    for (int lane = 0; lane < lanes; ++lane)
      for (const std::int64_t tet : {batch.tet[lane], batch.beyond_tet[lane]}) {
        TetRow& row = rows[tet >= 0 ? tet : tets];
        simd::store(row.component, load(row) + load(of_faces[lane]));
      }
  }
  for (std::int64_t b = 0; b < sides.tet_batches; ++b) {
    Oct v[lanes];
    for (int lane = 0; lane < lanes; ++lane)
      v[lane] = load(rows[b * lanes + lane]);
    simd::transpose(v);
    for (int c = 0; c < 6; ++c)
      simd::store(jumps[b].component[c], v[c]);
  }
}

CDEM_INLINE void side_force_kernel(const FaceSides& sides, const Node* position, const StressBatch* stress,
                                   const StressBatch* viscous, TetRow* rows, Node* force) {
  const std::int64_t tets = sides.tet_batches * lanes;
  simd::store(rows[tets].component, Oct{});
  for (std::int64_t b = 0; b < sides.tet_batches; ++b) {
    Oct s[6];
    for (int c = 0; c < 6; ++c)
      s[c] = simd::load(stress[b].component[c]) + (viscous ? simd::load(viscous[b].component[c]) : Oct{});
    store_rows(s, rows + b * lanes);
  }
  const Oct sixth = Oct{} + 1.0 / 6; // half the traction of each side, a third of it to each corner
  for (std::int64_t i = 0; i < sides.count; ++i) {
    const FaceSideBatch& batch = sides.batches[i];
    const Held together = held(batch, sides.faces);
    if (none(together))
      continue;
    Oct s[lanes];
    for (int lane = 0; lane < lanes; ++lane) {
      const std::int64_t beyond = batch.beyond_tet[lane];
      s[lane] = load(rows[batch.tet[lane]]) + load(rows[beyond >= 0 ? beyond : tets]);
    }
    simd::transpose(s);
    const Vec n =
        scaled(sixth * __builtin_convertvector(together, Oct),
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

TetRow* rows_of(const FaceSides& sides) {
  thread_local std::vector<TetRow> rows;
  rows.resize(static_cast<std::size_t>(sides.tet_batches * lanes + 1));
  return rows.data();
}

} // namespace

void find_jumps(const FaceSides& sides, const Node* position, const Node* velocity, double dt,
                JumpBatch* jumps) {
  if (sides.count == 0) {
    std::fill_n(jumps, sides.tet_batches, JumpBatch{});
    return;
  }
  simd::best<jump_kernel>(sides, position, velocity, dt, rows_of(sides), jumps);
}

void add_side_forces(const FaceSides& sides, const Node* position, const StressBatch* stress,
                     const StressBatch* viscous, Node* force) {
  simd::best<side_force_kernel>(sides, position, stress, viscous, rows_of(sides), force);
}

} // namespace cdem
