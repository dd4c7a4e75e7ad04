#include "libcdem/ranks/partition.hpp"

#include <algorithm>
#include <cassert>

namespace cdem {
namespace {

// Work of a bonded face, and of a spring between blocks, over that of a tet.
constexpr double face_load = 1.5, spring_load = 0.5;
// A tet of a rigid block takes memory only.
constexpr double rigid_load = 1e-3;

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

std::vector<double> chunk_loads(const Model& model) {
  std::vector<double> loads;
  loads.reserve(model.chunks.size());
  const std::size_t stars = model.chunks.size() - model.mesh.chunks.size();
  for (std::size_t c = 0; c < stars; ++c)
    loads.push_back(static_cast<double>(model.chunks[c].batches.size() * lanes));
  for (const MeshChunk& chunk : model.mesh.chunks)
    loads.push_back((is_rigid(model, chunk) ? rigid_load : 1) *
                    (static_cast<double>(chunk.tets.size()) + face_load * chunk.faces));
  return loads;
}

Partition::Partition(const Model& model, int of, int among)
    : rank(of), size(among), chunk_begin(even_shares(chunk_loads(model), among)),
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
