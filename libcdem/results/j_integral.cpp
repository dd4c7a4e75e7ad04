#include "libcdem/results/j_integral.hpp"

#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/load/resolve.hpp"
#include "libcdem/results/j_domain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdem {
namespace {

double length_of_front(const Model& model, const JFront& front, const JDomain& domain) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Block& block : model.blocks) {
    if (block.body != front.body)
      continue;
    for (int i = block.node_begin; i < block.node_end; ++i) {
      if (distance_from_front(front, model.node_position[i]) > domain.outer)
        continue;
      const double along = model.node_position[i].dot(front.front);
      low = std::min(low, along);
      high = std::max(high, along);
    }
  }
  return high - low;
}

double sum_over(const Model& model, const State& state, const JFront& front,
                const std::vector<DomainTet>& tets) {
  double sum = 0;
  for (const DomainTet& t : tets) {
    const geom::Mat3 stress = matrix(tet_stress(model, state, t.tet));
    const geom::Vec3 along = t.gradient * front.growth; // u_i,1
    const geom::Mat3 strain = 0.5 * (t.gradient + t.gradient.transpose());
    const double energy = 0.5 * stress.cwiseProduct(strain).sum();
    sum += t.volume * (stress * along - energy * front.growth).dot(t.weight_slope);
  }
  return sum;
}

} // namespace

double JIntegral::mean() const {
  double sum = 0;
  for (const JDomain& domain : domains)
    sum += domain.j;
  return sum / static_cast<double>(domains.size());
}

double JIntegral::spread() const {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const JDomain& domain : domains) {
    low = std::min(low, domain.j);
    high = std::max(high, domain.j);
  }
  return high > low ? (high - low) / std::abs(mean()) : 0;
}

JIntegral j_integral(const Model& model, const State& state, const ResolvedConditions& conditions,
                     const JFront& front, std::vector<JDomain> domains) {
  JIntegral result;
  for (JDomain& domain : domains) {
    const std::vector<DomainTet> tets = domain_tets(model, state, front, domain);
    require_valid(model, state, conditions, front, domain, tets);
    result.thickness = length_of_front(model, front, domain);
    domain.j = sum_over(model, state, front, tets) / result.thickness;
  }
  result.domains = std::move(domains);
  return result;
}

} // namespace cdem
