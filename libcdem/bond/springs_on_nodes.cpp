// What springs do to the nodes on which they act.
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/parallel/simd.hpp"

namespace cdem {
namespace {

CDEM_INLINE void bond_force_kernel(const Model& model, const geom::Vec3* bond_force, Range nodes,
                                   Node* force) {
  constexpr double sign[2] = {1, -1}; // of the only node of side a, b
  const std::int64_t* const begin = model.bond_begin.data();
  const SpringEnd* const ends = model.spring_ends.data();
  for (std::int64_t node = nodes.begin; node < nodes.end; ++node) {
    simd::Quad sum = simd::load(force[node - nodes.begin]);
    for (std::int64_t i = begin[node]; i < begin[node + 1]; ++i) {
      const SpringEnd end = ends[i];
      const double* const spring = bond_force[end.point()].data();
      const double weight =
          end.end() >= SpringEnd::only_a ? sign[end.end() - SpringEnd::only_a] : end.weight(model.points);
      sum += weight * simd::Quad{spring[0], spring[1], spring[2], 0};
    }
    simd::store(force[node - nodes.begin], sum);
  }
}

} // namespace

void add_bond_forces(const Model& model, const std::vector<geom::Vec3>& bond_force, Range nodes,
                     Node* force) {
  if (!model.points.empty())
    simd::best<bond_force_kernel>(model, bond_force.data(), nodes, force);
}

void add_bond_reads(const Model& model, const BondWork& work, std::int64_t chunk, ReadAhead& ahead) {
  if (model.points.empty())
    return;
  const Range nodes = model.chunks[chunk].nodes, springs = work.new_springs[chunk];
  const std::int64_t end = model.bond_begin[nodes.begin];
  ahead.add(model.bond_begin.data() + nodes.begin, nodes.size());
  ahead.add(model.spring_ends.data() + end, model.bond_begin[nodes.end] - end);
  ahead.add(work.force().data() + springs.begin, springs.size());
}

void add_spring_row_sums(const Model& model, std::vector<double>& sums) {
  for (const BondPoint& point : model.points) {
    const geom::Mat3 k = point.ks_area * geom::Mat3::Identity() +
                         (point.kn_area - point.ks_area) * point.normal * point.normal.transpose();
    const double row = 2 * k.cwiseAbs().rowwise().sum().maxCoeff(); // weights of both sides sum to 2
    for (int i = 0; i < 3; ++i) {
      sums[point.node_a[i]] += point.weight_a[i] * row;
      sums[point.node_b[i]] += point.weight_b[i] * row;
    }
  }
}

} // namespace cdem
