#include "libcdem/ranks/partition.hpp"

#include "libcdem/state/state.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <numeric>

namespace cdem {
namespace {

// Work of a bonded face, and of a spring between blocks, over that of a tet.
constexpr double face_load = 1.5, spring_load = 0.5;
// Further work of a face that has broken and is not left to contact: its springs slide one by one.
constexpr double broken_load = 4;
// A tet of a rigid block takes memory only.
constexpr double rigid_load = 1e-3;

int broken_faces(const State& state, const MeshChunk& chunk) {
  int broken = 0;
  for (int face = 0; face < chunk.faces; ++face) {
    const FaceStateBatch& batch = state.faces[chunk.face_batches.begin + face / lanes];
    const int lane = face % lanes;
    const bool holds = std::all_of(std::begin(batch.mode), std::end(batch.mode),
                                   [&](const auto& point) { return is_intact(point[lane]); });
    broken += !holds && !handed_over(batch, lane) ? 1 : 0;
  }
  return broken;
}

} // namespace

std::vector<std::int64_t> even_shares(const std::vector<double>& load, int size) {
  std::vector<std::int64_t> begin{0};
  double all = 0;
  for (const double one : load)
    all += one;
  double before = 0;
  std::int64_t item = 0;
  for (int rank = 1; rank < size; ++rank) {
    const double goal = all * rank / size;
    for (; item < static_cast<std::int64_t>(load.size()) && before + 0.5 * load[item] < goal; ++item)
      before += load[item];
    begin.push_back(item);
  }
  begin.push_back(static_cast<std::int64_t>(load.size()));
  return begin;
}

std::vector<double> chunk_loads(const Model& model, const State& state, Range chunks) {
  std::vector<double> loads;
  loads.reserve(static_cast<std::size_t>(chunks.size()));
  const auto stars = static_cast<std::int64_t>(model.chunks.size() - model.mesh.chunks.size());
  for (std::int64_t c = chunks.begin; c < chunks.end; ++c) {
    if (c < stars) {
      loads.push_back(static_cast<double>(model.chunks[c].batches.size() * lanes));
      continue;
    }
    const MeshChunk& chunk = model.mesh.chunks[c - stars];
    const double whole = static_cast<double>(chunk.tets.size()) + face_load * chunk.faces;
    loads.push_back(is_rigid(model, chunk) ? rigid_load * whole
                                           : whole + broken_load * broken_faces(state, chunk));
  }
  return loads;
}

double imbalance(const std::vector<double>& load, const std::vector<std::int64_t>& begin) {
  double most = 0, all = 0;
  for (std::size_t rank = 0; rank + 1 < begin.size(); ++rank) {
    const double own = std::accumulate(load.begin() + begin[rank], load.begin() + begin[rank + 1], 0.0);
    most = std::max(most, own);
    all += own;
  }
  return all > 0 ? most * static_cast<double>(begin.size() - 1) / all : 1;
}

Partition::Partition(const Model& model, const std::vector<double>& loads, int of, int among)
    : rank(of), size(among), chunk_begin(even_shares(loads, among)),
      stars(static_cast<std::int64_t>(model.chunks.size() - model.mesh.chunks.size())) {
  std::vector<double> springs;
  springs.reserve(model.point_chunks.size());
  for (const Range& points : model.point_chunks)
    springs.push_back(spring_load * static_cast<double>(points.size()));
  point_begin = even_shares(springs, among);
  const auto nodes = static_cast<std::int64_t>(model.node_position.size());
  for (const std::int64_t chunk : chunk_begin)
    node_begin.push_back(
        chunk < static_cast<std::int64_t>(model.chunks.size()) ? model.chunks[chunk].nodes.begin : nodes);
  assert(node_begin.front() == 0 && std::is_sorted(node_begin.begin(), node_begin.end()));
}

Range Partition::mesh_chunks() const {
  const Range own = chunks();
  return {std::max(own.begin, stars) - stars, std::max(own.end, stars) - stars};
}

int Partition::owner(const std::vector<std::int64_t>& begin, std::int64_t item) {
  return static_cast<int>(std::upper_bound(begin.begin(), begin.end(), item) - begin.begin()) - 1;
}

} // namespace cdem
