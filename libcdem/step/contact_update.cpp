#include "libcdem/step/contact_update.hpp"

#include "libcdem/contact/broad_phase/rigid_pairs.hpp"
#include "libcdem/contact/broad_phase/search.hpp"
#include "libcdem/contact/broad_phase/tet_pairs.hpp"
#include "libcdem/contact/contact_forces.hpp"
#include "libcdem/contact/response/contact_bounds.hpp"
#include "libcdem/integrate/row_sums.hpp"
#include "libcdem/step/record.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cdem {
namespace {

// Steps between looks at which bodies have met, where as many contacts act as before.
constexpr std::int64_t meetings_every = 10;

} // namespace

ContactUpdate::ContactUpdate(const StageContext& context)
    : rigid_reach_(reaches_of_rigid(context.model, context.state)) {
  if (context.model.surface.empty())
    return;
  row_sums_ = all_row_sums(context.model);
  impact_frequency2_ = impact_frequencies2(context.model);
}

void ContactUpdate::evaluate(const StageContext& context, ContactWork& work, RunLog& log) {
  const bool looks = work.due;
  const ContactSums sums = contact_forces(context.model, context.state, work, context.threads);
  context.state.spent.friction += sums.friction;
  context.state.spent.damping += sums.damping;
  log.deepest_contact = std::max(log.deepest_contact, sums.depth);
  log.deepest_over_height = std::max(log.deepest_over_height, sums.depth_over_height);
  if (sums.deepest > deepest_.deepest)
    deepest_ = sums;
  if (looks && !work.due && (sums.contacts != contacts_before_ || context.state.step % meetings_every == 0)) {
    strike_out_met(context.model, context.state, log);
    contacts_before_ = sums.contacts;
  }
}

double ContactUpdate::longest_step(const StageContext& context, const Workspace& work, double safety,
                                   bool given, const StageStep& here) {
  const ContactSums sums = std::exchange(deepest_, {});
  if (sums.deepest > 1) {
    work.shared->gather(context.state);
    refuse_depth(context.model, context.state, sums.deepest_source, sums.deepest_target, here);
  }
  return std::min(
      contact_time_step(context.model, context.state, work.contact.loads,
                        {row_sums_, work.damped,
                         context.state.moving_mass.empty() ? work.bond.contact_damping : 0, safety, given}),
      displacement_time_step(context.model, context.state, rigid_reach_));
}

double ContactUpdate::longest_step_of_flight(const StageContext& context, const Workspace& work,
                                             double safety, bool damped) const {
  if (impact_frequency2_.empty())
    return std::numeric_limits<double>::infinity();
  const std::optional<Gravity>& gravity = context.conditions.gravity;
  return flight_time_step(
      context.model, context.state, work.contact.loads,
      {impact_frequency2_, work.resolved.rigid, gravity ? gravity->acceleration.norm() : 0, safety, damped});
}

void ContactUpdate::go_on(ContactWork& work) {
  std::fill(work.search.told_due.begin(), work.search.told_due.end(), 0);
  work.search.history_complete = true;
  work.search.anew = false;
}

void ContactUpdate::go_on_from_end(const StageContext& context, ContactWork& work) {
  rigid_reach_ = reaches_of_rigid(context.model, context.state);
  deepest_ = {};
  contacts_before_ = 0;
  work.options = {};
  work.step = 0;
  work.due = true;
  work.search.fragments_due = false;
}

void ContactUpdate::start_anew(const Model& model, const State& state, ContactWork& work,
                               bool same_surfaces) const {
  if (model.surface.empty())
    return;
  ContactWork before = std::move(work);
  work = {};
  start_contact(model, work);
  work.travel.last_step = before.travel.last_step;
  work.options = before.options;
  work.damps = before.damps;
  work.shared = before.shared;
  go_on(work);
  if (same_surfaces)
    keep_rigid_pairs(before, work);
  take_tet_pairs(model, state, std::move(before.tet_contacts), work);
}

void ContactUpdate::pass_restart_point(const Model& model, const State& state, ContactWork& work) const {
  if (work.search.count == 0) // started anew in this step
    return;
  // Several ranks share the rows by loads that have just been counted anew. Whether bodies without a law meet is asked in each search.
  const bool all_known = work.shared->alone() && !work.due && !work.search.fragments_due &&
                         std::isinf(work.search.undefined_pair_margin);
  if (!all_known)
    start_anew(model, state, work, true);
  work.due = true;
}

} // namespace cdem
