#include "libcdem/element/nodal_averages.hpp"

#include "libcdem/parallel/simd.hpp"

namespace cdem {
namespace {

using simd::Oct;
using simd::Vec;

constexpr double own_part = 0.1; // s

// Sums at the nodes of a chunk and the values of its tets, kept from call to call.
struct Averages {
  std::vector<Node> sums;      // sum V q, sum V (places)
  std::vector<JumpBatch> tets; // q, V of eight tets in the first two components
};

struct Tet {
  Vec c1, c2, c3; // 6 V grad of the shape functions
  Oct six_volume;
};

CDEM_INLINE Tet tet_of(const Vec& e1, const Vec& e2, const Vec& e3) {
  Tet tet{cross(e2, e3), cross(e3, e1), cross(e1, e2), {}};
  tet.six_volume = dot(e1, tet.c1);
  return tet;
}

CDEM_INLINE void add_to_nodes(const MeshBatch& batch, int used, const Oct& value, const Oct& volume,
                              JumpBatch& kept, Node* sums) {
  simd::store(kept.component[0], value);
  simd::store(kept.component[1], volume);
  for (int lane = 0; lane < used; ++lane)
    for (const auto& place : batch.place) {
      sums[place[lane]].x += volume[lane] * value[lane];
      sums[place[lane]].y += volume[lane];
    }
}

// The average of a value less the value; 0 past the last tet.
CDEM_INLINE Oct change(const MeshBatch& batch, int used, const JumpBatch& kept, const Node* sums) {
  Oct result{};
  for (int lane = 0; lane < used; ++lane) {
    double sum = 0;
    for (const auto& place : batch.place)
      sum += sums[place[lane]].x / sums[place[lane]].y;
    result[lane] = (1 - own_part) * (0.25 * sum - kept.component[0][lane]);
  }
  return result;
}

CDEM_INLINE int used_lanes(const AveragedTets& tets, std::int64_t batch) {
  return batch + 1 == tets.count ? tets.last_lanes : lanes;
}

CDEM_INLINE void volume_kernel(const AveragedTets& tets, const Node* velocity, double dt, Averages& averages,
                               JumpBatch* jumps) {
  const Oct half_dt = Oct{} + 0.5 * dt;
  for (std::int64_t i = 0; i < tets.count; ++i) {
    const MeshBatch& batch = tets.batches[i];
    const Vec x0 = simd::gather(tets.position, batch.place[0]), v0 = simd::gather(velocity, batch.place[0]);
    const auto edge = [&](int k) { return minus(simd::gather(tets.position, batch.place[k]), x0); };
    const auto relative = [&](int k) { return minus(simd::gather(velocity, batch.place[k]), v0); };
    const Vec v1 = relative(1), v2 = relative(2), v3 = relative(3);
    const Tet t = tet_of(minus(edge(1), scaled(half_dt, v1)), minus(edge(2), scaled(half_dt, v2)),
                         minus(edge(3), scaled(half_dt, v3)));
    const Oct strain = dt / t.six_volume * (dot(v1, t.c1) + dot(v2, t.c2) + dot(v3, t.c3));
    add_to_nodes(batch, used_lanes(tets, i), strain, t.six_volume / 6, averages.tets[i],
                 averages.sums.data());
  }
  for (std::int64_t i = 0; i < tets.count; ++i) {
    const int used = used_lanes(tets, i);
    const Oct less = change(tets.batches[i], used, averages.tets[i], averages.sums.data());
    const Oct third = (2.0 / 3) * simd::load(averages.tets[i].component[1]) * less; // 2V of each direction
    for (int c = 0; c < 3; ++c)
      simd::store(jumps[i].component[c], simd::load(jumps[i].component[c]) + third);
  }
}

CDEM_INLINE void pressure_kernel(const AveragedTets& tets, const StressBatch* stress, Averages& averages,
                                 Node* force) {
  const auto at = [&](const MeshBatch& batch) {
    const Vec x0 = simd::gather(tets.position, batch.place[0]);
    return tet_of(minus(simd::gather(tets.position, batch.place[1]), x0),
                  minus(simd::gather(tets.position, batch.place[2]), x0),
                  minus(simd::gather(tets.position, batch.place[3]), x0));
  };
  for (std::int64_t i = 0; i < tets.count; ++i) {
    const StressBatch& s = stress[i];
    const Oct mean =
        (simd::load(s.component[0]) + simd::load(s.component[1]) + simd::load(s.component[2])) / 3;
    add_to_nodes(tets.batches[i], used_lanes(tets, i), mean, at(tets.batches[i]).six_volume / 6,
                 averages.tets[i], averages.sums.data());
  }
  for (std::int64_t i = 0; i < tets.count; ++i) {
    const MeshBatch& batch = tets.batches[i];
    const Tet t = at(batch);
    const Oct part = (-1.0 / 6) * change(batch, used_lanes(tets, i), averages.tets[i], averages.sums.data());
    const Vec f1 = scaled(part, t.c1), f2 = scaled(part, t.c2), f3 = scaled(part, t.c3);
    simd::scatter_add(force, batch.place[0],
                      Vec{-(f1.x + f2.x + f3.x), -(f1.y + f2.y + f3.y), -(f1.z + f2.z + f3.z)});
    simd::scatter_add(force, batch.place[1], f1);
    simd::scatter_add(force, batch.place[2], f2);
    simd::scatter_add(force, batch.place[3], f3);
  }
}

Averages& cleared(const AveragedTets& tets) {
  thread_local Averages averages;
  averages.sums.assign(static_cast<std::size_t>(tets.places), Node{});
  averages.tets.resize(static_cast<std::size_t>(tets.count));
  return averages;
}

} // namespace

void add_volume_averages(const AveragedTets& tets, const Node* velocity, double dt, JumpBatch* jumps) {
  simd::best<volume_kernel>(tets, velocity, dt, cleared(tets), jumps);
}

void add_pressure_averages(const AveragedTets& tets, const StressBatch* stress, Node* force) {
  simd::best<pressure_kernel>(tets, stress, cleared(tets), force);
}

} // namespace cdem
