// Distance of a model from equilibrium: the net forces of its free nodes over a reference force. The reference is the
// weight of the node's block unless another is given. Held components, nodes of rigid bodies and velocities do not
// count.
#pragma once

#include "libcdem/load/conditions.hpp"
#include "libcdem/load/resolve.hpp"
#include "libcdem/state/state.hpp"

#include <optional>

namespace cdem {

struct Unbalance {
  double largest = 0, mean = 0;          // net force over reference
  double force = 0;                      // N, net force where the ratio is largest
  std::int64_t block = 0;                // id, there
  geom::Vec3 place = geom::Vec3::Zero(); // m, undeformed, there
};

// force: net forces, N (n_nodes). reference: N, > 0; without it gravity must act. Throws geom::InputError.
Unbalance unbalance(const Model&, const ResolvedConditions&, const std::vector<Node>& force,
                    const std::optional<Gravity>&, std::optional<double> reference);

} // namespace cdem
