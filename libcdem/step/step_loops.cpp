#include "libcdem/step/step_loops.hpp"

namespace cdem {

NodeSums sums_of(const Workspace& work) {
  NodeSums sum;
  const auto add = [&](const NodeSums& s) {
    sum.residual2 += s.residual2;
    sum.applied2 += s.applied2;
    sum.reaction2 += s.reaction2;
    sum.stiffness += s.stiffness;
    sum.inertia += s.inertia;
    sum.kinetic += s.kinetic;
    sum.external += s.external;
    sum.damping += s.damping;
    sum.radiated += s.radiated;
  };
  for (const NodeSums& s : work.node_sums)
    add(s);
  for (const NodeSums& s : work.rigid_sums)
    add(s);
  return sum;
}

} // namespace cdem
