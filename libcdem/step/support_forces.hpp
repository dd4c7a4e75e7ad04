// Forces of supports, and the momentum of bodies: what probes of the history sample beside fields.
#pragma once

#include "libcdem/results/log.hpp"
#include "libcdem/step/workspace.hpp"

#include <optional>

namespace cdem {

// N, of what holds the model from outside: supports, as their nodes would need it else; quiet boundaries and free fields,
//
//   R = R0 - C v + (loads of the waves that enter, stress and dashpots of the columns),
//
// R0 the reaction of the support whose place the boundary took, C its dashpots, v the velocity of the nodes (half a step
// old in a run). A node of an edge counts in both its sides.
class SupportForces {
public:
  // contacts: as of a Workspace.
  SupportForces(const Model&, const State&, const Conditions&, int threads,
                const ContactLoads* contacts = nullptr);
  geom::Vec3 reaction(const Selection&) const; // throws geom::InputError when it holds no nodes

private:
  const Model& model_;
  Workspace work_;
  std::vector<Node> net_; // N (n_nodes)
  std::vector<Node>
      boundary_; // N, what boundaries do beside their dashpots (n_nodes); empty without boundaries
  const State& state_;
};

// What all who look at a stage between two steps share (SynchronisedView).
struct SeenForces {
  const ContactLoads* contacts = nullptr; // of the present places; null: nobody looks
  std::optional<SupportForces> supports;  // found by the first who asks
};
// N; found anew where nobody looks at a stage. Throws geom::InputError when the selection holds no nodes.
geom::Vec3 reaction(const Model&, const State&, const Conditions&, int threads, SeenForces&,
                    const Selection&);

geom::Vec3 momentum_of(const Model&, const State&, int body); // N s

bool is_momentum(const Probe&);
Selection place_of_support(const Model&, const std::string& on); // a side or a body, by name

} // namespace cdem
