#include "libcdem/step/step.hpp"

#include "libcdem/step/synchronised_view.hpp"

namespace cdem {

void Stage::make_steps(Procedure& by) {
  while (!by.is_over())
    make_step(by);
}

// Each line is one of StepTimes, or counts to the next that is.
void Stage::make_step(Procedure& by) {
  progress_.times.end(StepLine::others);
  const double began = context_.state.time;
  const bool renewed = renew_interfaces();        // of blocks that have slid past each other: other springs
  const bool freed = split_nodes(by.time_step()); // of cohesive bodies, where faces near their strength
  const bool joined = join_nodes();               // where nothing has cracked and the body is at rest
  const bool changed = renewed || freed || joined;
  by.begin_step(changed, joined);
  if (changed || can_be_left())
    keep_restart_point(by.loop_state());

  by.take_contacts(update_contacts()); // for where the nodes are
  by.update_loads();                   // at this time

  begin_forces();
  begin_cracks();
  bond_forces();          // springs between blocks
  element_forces(by);     // and bonds inside meshes; moves the nodes that no other chunk touches
  shared_node_forces(by); // moves those of several
  rigid_bodies(by);
  sum_up(); // over all ranks

  end_step(by.time_step());
  by.end_step();
  report.residual = relative_residual(report.sums);
  watch(); // energies, breaks, soundness, histories, progress, stop
  by.judge();
  look(*this, looks, began, context_.state.time);
}

} // namespace cdem
