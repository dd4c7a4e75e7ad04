// Masses of a relaxation with unit steps: central differences are stable for m >= sum_j |K_ij| / 4 (Gershgorin).
//
// The stiffness that a contact adds depends on where it acts: at the tip of a wedge it may be ten times as stiff as the
// faces around it. So the mass of a node is raised for the contacts that act on it, and never lowered again. A contact
// too stiff for its node would throw the node back and forth for ever, and the relaxation would never settle.
#pragma once

#include "libcdem/contact/data/contact_force.hpp"
#include "libcdem/load/bolts.hpp"
#include "libcdem/model/model.hpp"

namespace cdem {

class FictitiousMasses {
public:
  FictitiousMasses(const Model&, const std::vector<ResolvedBolt>&);

  const std::vector<double>& of_nodes() const { return mass_; } // kg for a unit step (n_nodes)
  // Before every step, when its contacts are known.
  void follow(const Model&, const ContactLoads&);

  // For a stage that goes on: numbers that a later add_to gives again. take returns the place behind them.
  void add_to(std::vector<double>& loop_state) const;
  std::size_t take(const std::vector<double>& loop_state, std::size_t from);

private:
  void raise(int node);

  std::vector<double> row_sums_, mass_; // N/m, without contacts; kg
  std::vector<int> raised_;             // nodes, each once, in the order in which they were
  std::vector<char> is_raised_;         // empty: none
};

} // namespace cdem
