#include "libcdem/step/stage.hpp"

#include "libcdem/bond/release.hpp"
#include "libcdem/contact/contact_bounds.hpp"
#include "libcdem/contact/contact_forces.hpp"
#include "libcdem/contact/search.hpp"
#include "libcdem/integrate/row_sums.hpp"
#include "libcdem/parallel/huge_pages.hpp"
#include "libcdem/step/errors.hpp"
#include "libcdem/step/mesh_forces.hpp"
#include "libcdem/step/record.hpp"
#include "libcdem/step/soundness.hpp"

#include <cmath>

namespace cdem {
namespace {

constexpr std::int64_t poll_every = 16;
// Steps between looks at which faces a flow meets: they turn by next to nothing in between.
constexpr std::int64_t flow_every = 100;
static_assert(watch_every % flow_every == 0, "a stage that goes on looks anew where it did when it was left");
// Steps between looks at which interfaces of blocks have parted.
constexpr std::int64_t release_every = 20;
static_assert(watch_every % release_every == 0, "as above");
// Steps between looks at which units have left their place.
constexpr std::int64_t look_every = 50;
static_assert(watch_every % look_every == 0, "as above");
// Steps between looks at which bodies have met, where the number of contacts stays the same.
constexpr std::int64_t meetings_every = 10;
// Chunks a thread must have before a further one is worth its two barriers a step: about half a millisecond of work.
constexpr std::int64_t chunks_per_thread = 32;
// The same where contacts are looked for, which is most of the work of a pile.
constexpr std::int64_t touching_chunks_per_thread = 6;

// What a step goes through from end to end.
void ask_for_huge_pages_of(const Model& model, const State& state, const Workspace& work) {
  ask_for_huge_pages(state.displacement);
  ask_for_huge_pages(state.velocity);
  ask_for_huge_pages(state.stress);
  ask_for_huge_pages(state.faces);
  ask_for_huge_pages(model.mesh.batches);
  ask_for_huge_pages(model.mesh.faces);
  ask_for_huge_pages(model.mesh.shares);
  ask_for_huge_pages(model.node_position);
  ask_for_huge_pages(model.node_mass);
  ask_for_huge_pages(work.partial);
}

} // namespace

int useful_threads(const Model& model, int threads) {
  const auto chunks = static_cast<std::int64_t>(model.chunks.size());
  const std::int64_t each = model.surface.empty() ? chunks_per_thread : touching_chunks_per_thread;
  return static_cast<int>(std::clamp<std::int64_t>(chunks / each, 1, threads));
}

double relative_residual(const NodeSums& sums) {
  const double reference = sums.applied2 > 0 ? sums.applied2 : sums.reaction2;
  if (reference > 0)
    return std::sqrt(sums.residual2 / reference);
  return sums.residual2 > 0 ? 1.0 : std::isnan(sums.residual2) ? sums.residual2 : 0.0;
}

void leave_from_here(const StageContext& context) {
  context.last_good = context.state;
  if (!context.moment)
    return;
  Moment moment;
  moment.breaks = context.log.breaks.size();
  moment.broken_tension_before = context.log.broken_tension;
  moment.broken_shear_before = context.log.broken_shear;
  if (context.beside)
    moment.beside = context.beside();
  *context.moment = std::move(moment);
  if (context.keeper)
    context.keeper->marked();
}

Stage::Stage(const StageContext& context, std::string kind, double run_away)
    : work(context.model, context.state, context.conditions), context_(context),
      threads_(useful_threads(context.model, context.threads)), kind_(std::move(kind)), run_away_(run_away),
      broken_tension_before_(context.log.broken_tension), broken_shear_before_(context.log.broken_shear),
      start_(std::chrono::steady_clock::now()),
      telling_(context.observer, context.log, context.from ? context.from->step : 0) {
  context_.threads = threads_.threads();
  ask_for_huge_pages_of(context_.model, context_.state, work);
  start_spring_forces(context_.model, context_.state, work.bond);
  if (const Moment* from = context_.from) {
    context_.last_good = context_.state;
    if (context_.moment)
      *context_.moment = *from;
    step = from->step;
    work.contact.all_known = step > 0;
    broken_tension_before_ = from->broken_tension_before;
    broken_shear_before_ = from->broken_shear_before;
    work.bond.spring_force = from->spring_force;
    work.bond.stretch = from->stretch;
    start_ -= std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(from->wall_time));
  } else {
    leave_from_here(context_);
  }
  if (!context_.model.surface.empty())
    row_sums_ = all_row_sums(context_.model);
  rigid_reach_ = reaches_of_rigid(context_.model, context_.state);
}

void Stage::mark(std::vector<double> carried, const std::vector<Node>& previous_force) {
  Moment& moment = **context_.moment;
  if (moment.step == step)
    return;
  moment.step = step;
  moment.breaks = context_.log.breaks.size();
  moment.wall_time = wall_time();
  moment.carried = std::move(carried);
  moment.previous_force = previous_force;
  moment.spring_force = work.bond.spring_force;
  moment.stretch = work.bond.stretch;
  if (context_.beside)
    moment.beside = context_.beside();
  // Contacts are looked for anew here, as by a stage that goes on: which pairs sleep is not saved.
  if (!context_.model.surface.empty()) {
    ContactWork before = std::move(work.contact);
    work.contact = {};
    start_contact(context_.model, work.contact);
    work.contact.pace = std::move(before.pace); // how thick skins are changes no force
    work.contact.most_friction = before.most_friction;
    work.contact.restitution = before.restitution;
    work.contact.all_known = true; // those of the step before
  }
  if (context_.keeper)
    context_.keeper->marked();
}

Stage::~Stage() {
  catch_up();
}

void Stage::moved(double time_step) {
  work.strain_step = time_step;
  work.contact.step += time_step;
  work.contact.due = true;
}

double Stage::meet(double safety) {
  const Model& model = context_.model;
  meet_contacts();
  const ContactSums sums = std::exchange(met_, {});
  if (sums.deepest > 1)
    refuse_depth(model, context_.state, sums.deepest_source, sums.deepest_target, here());
  return std::min(contact_time_step(model, context_.state, work.contact, {row_sums_, work.damped, safety}),
                  way_time_step(model, context_.state, rigid_reach_));
}

double Stage::wall_time() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Stage::catch_up() {
  catch_up_contacts();
  catch_up_meshes();
}

void Stage::meet_contacts() {
  const ContactSums sums = contact_forces(context_.model, context_.state, work.contact, context_.threads);
  context_.state.spent.friction += sums.friction;
  context_.state.spent.damping += sums.damping;
  context_.log.deepest_contact = std::max(context_.log.deepest_contact, sums.depth);
  context_.log.deepest_over_height = std::max(context_.log.deepest_over_height, sums.depth_over_height);
  if (sums.deepest > met_.deepest)
    met_ = sums;
  const std::size_t contacts = context_.state.contacts.size();
  if (contacts != contacts_before_ || step % meetings_every == 0)
    strike_out_met(context_.model, context_.state, context_.log);
  contacts_before_ = contacts;
}

void Stage::catch_up_contacts() {
  try {
    meet_contacts();
  } catch (const SolutionError&) { // the next step meets it again, and says so
  }
}

void Stage::catch_up_meshes() {
  const auto meshes = static_cast<std::int64_t>(context_.model.mesh.chunks.size());
  work.hand_over_due = step % hand_over_every == 0;
  if (work.strain_step > 0)
    for_chunks(meshes, context_.threads, [&](std::int64_t c) {
      if (!is_rigid(context_.model, context_.model.mesh.chunks[c]))
        mesh_forces(context_.model, context_.state, work, c, false);
    });
  // Broken faces slide to where the nodes are too; the next step finds nothing left to do.
  if (work.strain_step > 0)
    for (const FaceSums& sums : work.face_sums) {
      context_.state.spent.friction += sums.friction;
      context_.state.spent.breaking += sums.breaking;
      context_.state.spent.damping += sums.damping;
      if (sums.hands_over) // what is handed over now is looked for where things stand now
        work.contact.pieces_due = work.contact.due = true;
    }
  work.strain_step = 0;
}

Stage::Look::Look(Stage& stage) : stage_(stage) {
  stage.catch_up_contacts();
  const State& state = stage.context_.state;
  if (!state.faces.empty() && stage.work.strain_step > 0) {
    strain_step_ = stage.work.strain_step;
    contact_due_ = stage.work.contact.due;
    pieces_due_ = stage.work.contact.pieces_due;
    stress_ = state.stress;
    viscous_stress_ = state.viscous_stress;
    faces_ = state.faces;
    face_slip_ = state.face_slip;
    spent_ = state.spent;
  }
  stage.catch_up_meshes();
}

Stage::Look::~Look() {
  if (strain_step_ == 0)
    return;
  State& state = stage_.context_.state;
  stage_.work.strain_step = strain_step_;
  stage_.work.contact.due = contact_due_;
  stage_.work.contact.pieces_due = pieces_due_;
  state.stress = stress_; // copied: the step knows where these lie
  state.viscous_stress = viscous_stress_;
  state.faces = faces_;
  state.face_slip = face_slip_;
  state.spent = spent_;
}

void Stage::keep_state() {
  require_sound(context_.model, context_.state, work, run_away_, here());
  require_neighbours(context_.model, context_.state, here());
  // Pieces are told apart anew when a face is handed over, and here: a run that goes on from a checkpoint does so too.
  if (!context_.state.face_slip.empty())
    work.contact.pieces_due = true;
  catch_up();
  look_for_escapes();
  context_.last_good = context_.state;
}

void Stage::look_for_escapes() {
  bool holds = false;
  for (const Escape& escape : find_escapes(context_.model, context_.state, work.resolved, escapes)) {
    require_kept_energy(context_.model, context_.state, escape, here());
    context_.log.escapes.push_back({context_.number, context_.state.step, context_.state.time,
                                    in_words(escape, context_.state, here())});
    context_.observer.warning("warning: " + context_.log.escapes.back().text);
    holds = holds || escape.held;
  }
  if (!holds)
    return;
  work.resolved = resolve(context_.model, context_.state, context_.conditions);
  update_external(work.resolved, context_.state.time);
}

NodeSums Stage::total() const {
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
  };
  for (const NodeSums& s : work.node_sums)
    add(s);
  for (const NodeSums& s : work.rigid_sums)
    add(s);
  return sum;
}

void Stage::after_step(const StepReport& report) {
  EnergyLedger& spent = context_.state.spent;
  broken_in_step_ =
      record_bond_breaks(context_.model, context_.state, work, context_.log, context_.number, step);
  broken_in_step_ +=
      record_face_breaks(context_.model, context_.state, work, context_.log, context_.number, step);
  spent.external += report.sums.external;
  spent.external_peak = std::max(spent.external_peak, std::abs(spent.external));
  spent.damping += report.sums.damping;
  ++step;
  ++context_.state.step;
  threads_.stepped();
  context_.threads = threads_.threads();
  // Sums over all forces and one over all velocities: a NaN anywhere shows here in the step it appears.
  if (!std::isfinite(report.sums.residual2) || !std::isfinite(report.sums.kinetic) ||
      !std::isfinite(report.sums.reaction2))
    require_sound(context_.model, context_.state, work, run_away_, here());
  if (follows_pieces)
    require_followed(context_.model, work, here());
  if (!context_.model.frames.empty() && step % release_every == 0) {
    const Released released = release_interfaces(context_.model, context_.state, context_.threads);
    spent.breaking += released.stored;
    work.contact.pieces_due = work.contact.pieces_due || released.interfaces > 0;
  }
  if (step % watch_every == 0)
    keep_state();
  if (!work.resolved.flows.empty() && step % flow_every == 0) {
    refresh_flows(context_.model, context_.state, work.resolved);
    update_external(work.resolved, context_.state.time);
  }
  if (context_.log.due(context_.state.step))
    sample(report);
  if (step % look_every == 0)
    look_at_units(context_.model, context_.state, context_.conditions, context_.log);
  // Not between the keeping of a state and its mark: the two would be of different moments.
  if (step % poll_every == 0 && !can_be_left()) {
    Keeper* const keeper = context_.keeper;
    if (context_.observer.stop_requested()) {
      if (keeper)
        keeper->write(true);
      throw Interrupted();
    }
    if (keeper && keeper->wanted())
      keeper->write(false);
    if (telling_.due())
      tell(report, false);
  }
  if (step == 1 || (context_.from && step == context_.from->step + 1))
    tell(report, false);
}

StageResult Stage::finish(const StepReport& report) {
  keep_state();
  look_at_units(context_.model, context_.state, context_.conditions, context_.log);
  sample(report);
  tell(report, true);
  return {step, report.residual, context_.log.broken_tension - broken_tension_before_,
          context_.log.broken_shear - broken_shear_before_, wall_time()};
}

void Stage::sample(const StepReport& report) {
  std::optional<Look> look;
  if (!context_.log.probes.empty())
    look.emplace(*this);
  record_history(context_.model, context_.state, context_.log, context_.number, report.residual,
                 report.sums.kinetic);
}

void Stage::tell(const StepReport& report, bool last) {
  Progress progress = report.goals;
  progress.stage = context_.number;
  progress.kind = kind_;
  progress.step = step;
  progress.residual = report.residual;
  progress.time = context_.state.time;
  progress.wall_time = wall_time();
  if (details)
    details(progress);
  telling_(std::move(progress), last);
}

} // namespace cdem
