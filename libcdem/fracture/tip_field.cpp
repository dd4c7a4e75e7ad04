#include "libcdem/fracture/tip_field.hpp"

#include "libcdem/element/small_strain.hpp"
#include "libgeom/core/portable.hpp"

#include <cmath>
#include <limits>

namespace cdem {

MeanField mean_field(const Model& model, const State& state, const geom::Vec3& centre, double radius) {
  const auto squared_distance = [&](int tet) {
    geom::Vec3 middle = geom::Vec3::Zero();
    for (const int node : model.tets[tet])
      middle += model.node_position[node] / 4;
    return (middle - centre).squaredNorm();
  };
  // Counted from the nearest element, so that a radius much smaller than the elements leaves that one alone
  // rather than nothing.
  double least = std::numeric_limits<double>::infinity();
  for (int tet = 0; tet < static_cast<int>(model.tets.size()); ++tet)
    least = std::min(least, squared_distance(tet));

  MeanField sum;
  double weights = 0;
  for (int tet = 0; tet < static_cast<int>(model.tets.size()); ++tet) {
    const double exponent = 2 * (squared_distance(tet) - least) / (radius * radius);
    if (exponent > 30)
      continue;
    const int block = model.tet_block[tet];
    const double w = geom::portable::exp(-exponent) * tet_volume(model, tet);
    const geom::Mat3 gradient = displacement_gradient(model, state.displacement, tet);
    sum.gradient += w * gradient;
    sum.stress += w * matrix(elastic_stress(model.bodies[model.blocks[block].body].material, gradient));
    if (tet < static_cast<int>(state.initial_stress.size()))
      sum.stress += w * matrix(state.initial_stress[tet]);
    weights += w;
  }
  sum.gradient /= weights;
  sum.stress /= weights;
  return sum;
}

} // namespace cdem
