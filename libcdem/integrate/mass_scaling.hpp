// Mass scaling of quasi-static stages: nodes whose stable step is shorter than the one named get just the mass that the
// step asks for (integrate/row_sums.hpp),
//
//   m = max(m, K (dt^2 + 2 beta dt) / 4),   K row sum of |K|, beta stiffness damping
//
// It is inertia only: weight is that of the true mass. What does not change is the balance a slow stage goes through; what
// does are waves and vibrations of the small elements.
#pragma once

#include "libcdem/model/model.hpp"

namespace cdem {

// kg, least mass of a node for which `step` (s) is stable; row_sum: N/m, damping: beta, s.
double least_mass(double row_sum, double damping, double step);

// kg (n_nodes); rigid bodies keep theirs. row_sums: N/m (n_nodes).
std::vector<double> scaled_masses(const Model&, const std::vector<double>& row_sums, double step);

struct AddedMass {
  double share = 0; // of the mass of all that deforms
  int body = -1;    // the one with the largest share of its own mass added; -1: none
  double body_share = 0;
};
AddedMass added_mass(const Model&, const std::vector<double>& moving); // kg (n_nodes)

} // namespace cdem
