// Model parts in the domain of a J integral, and whether the integral is the energy release rate there
// (results/j_integral.hpp).
#pragma once

#include "libcdem/load/resolve.hpp"
#include "libcdem/results/j_integral.hpp"

namespace cdem {

double distance_from_front(const JFront&, const geom::Vec3& place); // r, m
double weight_in_domain(const JDomain&, double distance);           // q

struct DomainTet {
  int tet = 0;
  double volume = 0;                            // m3
  geom::Mat3 gradient = geom::Mat3::Zero();     // du_i / dx_j
  geom::Vec3 weight_slope = geom::Vec3::Zero(); // grad q, 1/m
};

// The tets of the body in which q varies, in order.
std::vector<DomainTet> domain_tets(const Model&, const State&, const JFront&, const JDomain&);

// Throws geom::InputError.
void require_valid(const Model&, const State&, const ResolvedConditions&, const JFront&, const JDomain&,
                   const std::vector<DomainTet>&);

} // namespace cdem
