// Forces of supports, and the momentum of bodies: what probes of the history sample beside fields.
#pragma once

#include "libcdem/results/log.hpp"
#include "libcdem/step/workspace.hpp"

namespace cdem {

// N, of the supports: what the nodes they hold would need else. Quiet boundaries are none.
class SupportForces {
public:
  SupportForces(const Model&, const State&, const Conditions&);
  geom::Vec3 reaction(const Selection&) const; // throws geom::InputError when it holds no nodes

private:
  const Model& model_;
  Workspace work_;
  std::vector<Node> net_;
};

geom::Vec3 momentum_of(const Model&, const State&, int body); // N s

bool is_momentum(const Probe&);
Selection place_of_support(const Model&, const std::string& on); // a side or a body, by name

} // namespace cdem
