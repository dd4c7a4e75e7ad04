#include "libcdem/fracture/place_in_block.hpp"

#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/small_strain.hpp"

namespace cdem {
namespace {

// A place counts as inside a tet when no barycentric weight is below this.
constexpr double inside = -1e-6;

} // namespace

Eigen::Vector4d weights_in_tet(const Model& model, int tet, const geom::Vec3& place) {
  const geom::Tet& t = model.tets[tet];
  const auto& x = model.node_position;
  geom::Mat3 edges;
  edges << x[t[1]] - x[t[0]], x[t[2]] - x[t[0]], x[t[3]] - x[t[0]];
  const geom::Vec3 w = edges.inverse() * (place - x[t[0]]);
  return {1 - w.sum(), w[0], w[1], w[2]};
}

int tet_at(const Model& old, const Block& block, const geom::Vec3& place) {
  int best = block.tet_begin;
  double best_weight = -1e30;
  for (int tet = block.tet_begin; tet < block.tet_end; ++tet)
    if (const double w = weights_in_tet(old, tet, place).minCoeff(); w > best_weight) {
      best = tet;
      best_weight = w;
    }
  return best;
}

geom::Mat3 stress_at(const Model& old, const State& from, int block, const geom::Vec3& place) {
  const Block& b = old.blocks[block];
  geom::Mat3 sum = geom::Mat3::Zero();
  int count = 0;
  for (int tet = b.tet_begin; tet < b.tet_end; ++tet)
    if (weights_in_tet(old, tet, place).minCoeff() >= inside) {
      sum += matrix(b.meshed ? mesh_stress(old, from, tet) : tet_stress(old, from, tet));
      ++count;
    }
  if (count == 0)
    return matrix(block_stress(old, from, block));
  return sum / count;
}

} // namespace cdem
