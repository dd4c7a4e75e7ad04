#include "libcdem/step/step.hpp"

namespace cdem {

void make_step(Stage& stage, Procedure& procedure) {
  // The model becomes another one: interfaces that have slid, nodes that are freed, nodes that are joined again.
  const bool renewed = stage.renew_interfaces();
  const bool freed = procedure.breaks() && stage.split_nodes(procedure.time_step());
  const bool joined = procedure.joins() && stage.join_nodes();
  const bool changed = renewed || freed || joined;
  if (changed)
    procedure.take_changed_model(joined);
  // Before the restart point, which is where a stage that goes on begins.
  procedure.choose_step(changed);
  if (changed || stage.can_be_left())
    procedure.keep_restart_point();

  procedure.update_contacts(); // for where the nodes are; the longest step that they leave
  procedure.update_loads();    // at this time
  procedure.advance();         // forces, and the motion of nodes and rigid bodies
  stage.end_step(procedure.time_step());
  procedure.end_step();

  stage.watch(procedure.report); // energies, breaks, soundness, histories, progress, stop
  procedure.look();
}

} // namespace cdem
