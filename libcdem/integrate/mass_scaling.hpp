// Mass scaling of quasi-static stages: nodes with a stable step shorter than the step asked for get exactly the mass
// that this step needs (integrate/row_sums.hpp),
//
//   m = max(m, K (dt^2 + 2 beta dt) / 4),   K row sum of |K|, beta stiffness damping
//
// The added mass is inertia only: the weight is that of the true mass. So the equilibrium states of a slow stage do not
// change. Waves and vibrations of the small elements do.
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
