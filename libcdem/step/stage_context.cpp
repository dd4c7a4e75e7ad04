#include "libcdem/step/stage_context.hpp"

#include "libcdem/step/support_forces.hpp"

namespace cdem {

std::shared_ptr<SeenForces> nobody_looks() {
  return std::make_shared<SeenForces>();
}

StageContext stage_context(Model& model, State& state, const Conditions& conditions, RunLog& log,
                           State& last_good, Observer& observer, int threads, int number) {
  StageContext context{model, state, conditions, log, last_good, observer, threads, number};
  context.changing = &model;
  return context;
}

void keep_start_of_loop(const StageContext& context) {
  context.last_good = context.state;
  if (!context.restart_point)
    return;
  RestartPoint point;
  point.breaks = context.log.breaks.size();
  point.one_way = context.log.one_way;
  point.broken_tension_before = context.log.broken_tension;
  point.broken_shear_before = context.log.broken_shear;
  if (context.procedure_state)
    point.procedure_state = context.procedure_state();
  *context.restart_point = std::move(point);
  if (context.checkpoints)
    context.checkpoints->marked();
}

} // namespace cdem
