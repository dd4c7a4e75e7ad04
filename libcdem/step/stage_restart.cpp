// Where a stage can be left, and how it goes on from there (step/restart_point.hpp).
#include "libcdem/results/earlier_log.hpp"
#include "libcdem/step/stage.hpp"

#include <utility>

namespace cdem {

void mark_start_of_loop(const StageContext& context) {
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

void Stage::keep_restart_point(std::vector<double> loop_state) {
  if (can_be_left() && shares_.count_loads()) {
    see_whole();
    shares_.gather(work.bond);
    gather_carried();
    shares_.share_anew(moving(), here());
  }
  keep_last_good();
  shares_.give_back();
  if (!context_.restart_point)
    return;
  RestartPoint& point = **context_.restart_point;
  if (point.step == step && (step > 0 || begins_))
    return;
  point.step = step;
  point.wall_time = progress_.wall_time();
  note(point, std::move(loop_state));
  if (context_.procedure_state)
    point.procedure_state = context_.procedure_state();
  contacts_.pass_restart_point(context_.model, context_.state, work.contact);
  if (context_.checkpoints)
    context_.checkpoints->marked();
}

void Stage::keep_end(std::vector<double> loop_state) {
  if (!context_.restart_point)
    return;
  require_sound_state();
  synchronise_contacts(context_.log); // as the next step would
  keep_last_good();
  kept_end_ = true;
  contacts_as_kept_ =
      context_.model.surface.empty() || !(work.contact.due || work.contact.search.fragments_due);
  RestartPoint point;
  note(point, std::move(loop_state));
  *context_.restart_point = std::move(point);
}

void Stage::note(RestartPoint& point, std::vector<double> loop_state) const {
  point.begun = true;
  point.breaks = context_.log.breaks.size();
  point.one_way = context_.log.one_way;
  point.loop_state = std::move(loop_state);
  const StateShares& shares = work.shared->shares();
  point.carried.resize(carried.size());
  for (std::size_t i = 0; i < carried.size(); ++i)
    StateShares::copy(*carried[i], point.carried[i], shares.nodes());
  StateShares::copy(work.bond.spring_force, point.spring_force, shares.points());
  StateShares::copy(work.bond.stretch, point.stretch, shares.points());
  StateShares::copy(work.bond.viscous, point.viscous, shares.points());
  point.contact_step = work.contact.travel.last_step;
  point.strain_step = work.strain_step;
  point.near = work.near.crack_known ? near_of_all_ranks(work) : std::vector<std::uint8_t>();
  point.slid = slid_;
  point.flows = flow_patterns(work.resolved);
  if (context_.sliding)
    point.sliding = *context_.sliding;
}

void Stage::keep_last_good() {
  good_ = {work.strain_step, context_.log.breaks.size(), context_.log.one_way};
  work.shared->keep(context_.state, context_.last_good);
}

void Stage::go_back() {
  context_.state = context_.last_good;
  see_whole();
  work.strain_step = good_.strain_step;
  cdem::go_back(context_.log, context_.state.step, good_.breaks, good_.one_way);
  work.near.forget();
  work.contact.tet_contacts = nullptr; // of a state that was wrong
  contacts_.start_anew(context_.model, context_.state, work.contact, false);
}

void Stage::take_springs(const RestartPoint& from) {
  work.bond.spring_force = from.spring_force;
  work.bond.stretch = from.stretch;
  work.bond.viscous = from.viscous;
  if (!from.viscous.empty())
    work.bond.add_dashpots();
}

void Stage::go_on_from(const RestartPoint& from) {
  if (context_.restart_point)
    *context_.restart_point = from;
  step = from.step;
  broken_.tension_before = from.broken_tension_before;
  broken_.shear_before = from.broken_shear_before;
  if (!from.begun)
    return;
  begins_ = false;
  ContactUpdate::go_on(work.contact);
  work.contact.travel.last_step = from.contact_step;
  work.strain_step = from.strain_step;
  if (!from.near.empty())
    take_near_of_all(from.near, work);
  take_springs(from);
  slid_ = from.slid;
  take_flow_patterns(from.flows, work.resolved);
  place_water();
  update_external(work.resolved, context_.state.time, moving());
}

} // namespace cdem
