#include "libcdem/step/stage.hpp"

#include "libcdem/bond/fragments.hpp"
#include "libcdem/bond/release.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/contact/broad_phase/tet_pairs.hpp"
#include "libcdem/integrate/move_columns.hpp"
#include "libcdem/load/water_forces.hpp"
#include "libcdem/model/known_of_model.hpp"
#include "libcdem/parallel/huge_pages.hpp"
#include "libcdem/parallel/instruction_set.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/results/free_surface.hpp"
#include "libcdem/results/picture_snapshot.hpp"
#include "libcdem/step/errors.hpp"
#include "libcdem/step/mesh_forces.hpp"
#include "libcdem/step/record.hpp"
#include "libcdem/step/sliding_friction.hpp"
#include "libcdem/step/synchronised_view.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

namespace cdem {
namespace {

// Steps between questions whether to stop, to write a checkpoint, to show the progress.
constexpr std::int64_t poll_every = 16;
// Steps between looks at which faces a flow meets: they turn by next to nothing in between. And at most between those at which
// a field of water is asked, whose forces follow the faces in every step.
constexpr std::int64_t flow_every = 100, water_every = 20;
static_assert(watch_every % flow_every == 0 && watch_every % water_every == 0,
              "a stage that goes on looks anew where it did when it was left");
// Steps between looks at which interfaces of blocks have parted.
constexpr std::int64_t release_every = 20;
static_assert(watch_every % release_every == 0, "as above");
// Steps between looks at which units have left their place.
constexpr std::int64_t look_every = 50;
static_assert(watch_every % look_every == 0, "as above");

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
  ask_for_huge_pages(model.batches);
  ask_for_huge_pages(model.spring_ends);
  ask_for_huge_pages(model.bond_begin);
  ask_for_huge_pages(state.bond_offset);
  ask_for_huge_pages(state.bond_mode);
  ask_for_huge_pages(work.bond.spring_force);
  ask_for_huge_pages(work.bond.acting_force);
  ask_for_huge_pages(work.bond.batches.springs);
  ask_for_huge_pages(work.bond.batches.interfaces);
}

bool in_water(const ResolvedConditions& r) {
  return std::any_of(r.flows.begin(), r.flows.end(), [](const ResolvedFlow& f) { return f.water; });
}

// A NaN anywhere shows in the sums over all forces or in the one over all velocities in the step it appears.
bool finite(const NodeSums& sums) {
  return std::isfinite(sums.residual2) && std::isfinite(sums.kinetic) && std::isfinite(sums.reaction2);
}

} // namespace

double residual_reference2(const NodeSums& sums) {
  return sums.applied2 > 0 ? sums.applied2 : sums.reaction2;
}

double relative_residual(const NodeSums& sums) {
  if (const double reference = residual_reference2(sums); reference > 0)
    return std::sqrt(sums.residual2 / reference);
  return sums.residual2 > 0 ? 1.0 : std::isnan(sums.residual2) ? sums.residual2 : 0.0;
}

Stage::Stage(const StageContext& context, std::string kind, double run_away)
    : Stage(context, std::move(kind), run_away,
            context.kept ? std::exchange(*context.kept, nullptr) : nullptr) {}

Stage::Stage(const StageContext& context, std::string kind, double run_away,
             const std::shared_ptr<KeptWork>& kept)
    : Stage(context, std::move(kind), run_away, kept.get(),
            context.from && kept && kept->end ? &*kept->end : nullptr) {}

Stage::Stage(const StageContext& context, std::string kind, double run_away, KeptWork* kept,
             KeptWork::End* end)
    : work(end ? Workspace(context.model, context.state, context.conditions, std::move(end->bond),
                           std::move(end->contact))
               : Workspace(context.model, context.state, context.conditions)),
      context_(context), threads_(useful_threads(context.model, context.threads)),
      contacts_(end ? std::move(end->contacts) : ContactUpdate(context)),
      watch_(StrengthWatch::of(context.model)),
      run_away_(run_away), broken_{0, 0, context.log.broken_tension, context.log.broken_shear},
      progress_(context, std::move(kind)), shares_(context_, work) {
  work.watch = watch_.empty() ? nullptr : &watch_;
  (void)instruction_set(); // a bad name of one is told of here, not by a thread
  context_.threads = threads_.threads();
  ask_for_huge_pages_of(context_.model, context_.state, work);
  if (end) {
    contacts_.go_on_from_end(context_, work.contact);
    work.bond.contact_damping = work.bond.damping_step = 0;
    stable = end->stable;
    tets_by_place_ = end->tets_by_place;
  } else {
    start_spring_forces(context_.model, context_.state, work.bond);
    if (context_.before && !context_.procedure_state)
      take_springs(*context_.before);
    if (kept && kept->tet_contacts && kept->model == fingerprint(context_.model))
      take_tet_pairs(context_.model, context_.state, std::move(kept->tet_contacts), work.contact);
  }
  shares_.share(moving());
  if (context_.sliding && !(context_.from && context_.from->begun))
    context_.sliding->seen = context_.state.time;
  if (context_.from)
    go_on_from(*context_.from);
  else
    mark_start_of_loop(context_);
  keep_last_good();
  shares_.give_back();
}

Stage::~Stage() {
  if (shares_.left_alone() || !work.shared) // change_nodes has failed
    return;
  synchronise();
  if (shares_.has_failed()) // the last good state is written
    work.shared->shares().gather_on_lead(context_.last_good);
}

double Stage::update_contacts() {
  progress_.times.end(StepLine::others);
  const std::int64_t searches = work.contact.search.count;
  contacts_.evaluate(context_, work.contact, context_.log);
  const double longest = contacts_.longest_step(context_, work, safety, step_is_given, here());
  if (!context_.model.surface.empty())
    progress_.times.end(work.contact.search.count > searches ? StepLine::contact_search : StepLine::contacts);
  return longest;
}

void Stage::update_loads(const Stepping* stepping) {
  ResolvedConditions& r = work.resolved;
  const double time = context_.state.time;
  if (stepping) {
    time_step_ = stepping->time_step; // it may have become shorter since nodes were split
    kick_ = stepping->kick;
    advance_columns(r, context_.state, {time, stepping->time_step, stepping->kick});
    update_supports(r, time + 0.5 * stepping->time_step);
  } else if (r.bolts.empty() && !in_water(r)) {
    return;
  }
  place_water();
  if (!r.bolts.empty())
    advance_bolts(r.bolts, context_.state, r.varying[r.bolt_load].forces);
  update_external(r, time, moving());
  progress_.times.end(StepLine::loads);
}

void Stage::place_water() {
  cdem::place_water(context_.model, context_.state, work.part().nodes(), context_.threads, work.resolved);
}

double Stage::update_crack_pressures(double stable_step) {
  std::vector<CrackLoad>& cracks = work.resolved.cracks;
  cdem::update_crack_pressures(context_.model, context_.state, work.part().mesh_chunks(), context_.state.time,
                               cracks);
  return crack_time_step(cracks, stable_step);
}

void Stage::carry_water(const std::vector<double>& water) {
  State& state = context_.state;
  if (water.empty() && state.moving_mass.empty())
    return;
  see_whole(); // for its kinetic energy
  std::vector<double> masses = water.empty() ? std::vector<double>() : context_.model.node_mass;
  for (std::size_t i = 0; i < water.size(); ++i)
    masses[i] += water[i];
  if (masses == state.moving_mass)
    return;
  const double before = kinetic_energy(context_.model, state);
  state.moving_mass = std::move(masses);
  state.spent.external += kinetic_energy(context_.model, state) - before;
}

void Stage::end_step(double time_step) {
  work.strain_step = time_step;
  work.contact.step += time_step;
  work.contact.due = true;
  ++step;
  ++context_.state.step;
  threads_.stepped();
  context_.threads = threads_.threads();
}

void Stage::synchronise() {
  if (shares_.left_alone())
    return;
  synchronise_contacts(context_.log);
  broken_.between += synchronise_stress(context_.log);
  see_whole();
}

void Stage::synchronise_contacts(RunLog& log) {
  contacts_as_kept_ = contacts_as_kept_ && !work.contact.due;
  try {
    contacts_.evaluate(context_, work.contact, log);
  } catch (const SolutionError&) { // the next step meets it again, and says so
  }
}

std::int64_t Stage::synchronise_stress(RunLog& log) {
  std::int64_t broken = 0;
  work.hand_over_due = is_due(hand_over_every);
  if (work.strain_step > 0) {
    work.shared->parted(context_.state);
    for_chunks(work.part().mesh_chunks(), context_.threads, [&](std::int64_t c) {
      if (!is_rigid(context_.model, context_.model.mesh.chunks[c]))
        mesh_forces(context_.model, context_.state, work, c, breaking_);
    });
    work.shared->share_nodes(context_.state); // for the stress beside faces of others
    BegunCracks begun;
    if (breaking_ && !context_.model.mesh.sides.empty()) {
      work.near.forget();
      begun = begun_cracks();
    }
    work.strain_step = 0;
    std::int64_t tellers = has_to_tell(work, begun) ? 1 : 0;
    ranks().sum(&tellers, 1);
    share_sums(work, begun, tellers);
    // Faces break and slide to where the nodes are too; the next step finds nothing left to do.
    broken = record_face_breaks(context_.model, context_.state, work, log, context_.number, step - 1) +
             record_begun_cracks(context_.model, context_.state, begun, log, context_.number, step - 1);
    for (const FaceSums& sums : work.face_sums)
      if (sums.hands_over) // what is handed over now is looked for where things stand now
        work.contact.due = true;
  }
  work.near.forget();
  return broken;
}

// The steps of a relaxation are no times.
void Stage::look_at_sliding() {
  const std::vector<Block>& blocks = context_.model.blocks;
  if (!in_real_time || !context_.sliding ||
      std::none_of(blocks.begin(), blocks.end(), [](const Block& b) { return b.rigid < 0; }))
    return;
  const Range own = work.shared->shares().points();
  const std::vector<std::uint8_t>& modes = context_.state.bond_mode;
  const bool dry = ranks().any(std::any_of(modes.begin() + own.begin, modes.begin() + own.end,
                                           [](std::uint8_t mode) { return !is_intact(mode); }));
  if (!dry && context_.model.surface.empty())
    return;
  see_whole();
  if (dry)
    shares_.gather(work.bond);
  context_.sliding->look(context_.model, context_.state, work.bond, work.contact.fragments.broken);
}

// Contact is told of the bonds of a block when a face is handed over, or an interface left to contact, of it or of those that
// are held to it, and of all blocks here.
void Stage::look_over() {
  if (!kept_end_)
    require_sound_state();
  const bool faces = !context_.state.face_slip.empty() || !context_.model.mesh.sides.empty();
  if (faces || !all_bonds_are_told(context_.model, context_.state)) {
    work.contact.search.fragments_due = true;
    work.contact.search.anew = work.contact.search.anew || faces;
    std::fill(work.contact.search.told_due.begin(), work.contact.search.told_due.end(), 1);
  }
  progress_.times.end(StepLine::watch);
  synchronise_contacts(context_.log);
  progress_.times.end(StepLine::contact_search);
  broken_.between += synchronise_stress(context_.log);
  progress_.times.end(StepLine::elements);
  if (work.contact.search.fragments_due) // faces have been handed over: a stage that goes on would not know
    synchronise_contacts(context_.log);
  progress_.times.end(StepLine::contact_search);
  look_for_escapes();
}

// Each rank looks at its share; what is wrong is told of by all, as one that sees everything.
void Stage::require_sound_state() {
  if (!ranks().alone() && !ranks().any(!share_is_sound(context_.model, context_.state, work, run_away_)))
    return;
  see_whole();
  require_sound(context_.model, context_.state, run_away_, here());
  require_neighbours(context_.model, context_.state, here());
}

void Stage::look_for_escapes() {
  if (!ranks().any(any_is_out(context_.model, context_.state, escapes, work.part().nodes())))
    return;
  see_whole();
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
  shares_.loads_are_whole();
  work.resolved = resolve(context_.model, context_.state, context_.conditions);
  update_external(work.resolved, context_.state.time, moving());
}

void Stage::watch() {
  if (std::exchange(sampled_start_, false))
    context_.log.history.back().residual = report.residual;
  record_step();
  if (!finite(report.sums)) {
    see_whole();
    require_sound(context_.model, context_.state, run_away_, here());
  }
  if (follows_fragments)
    require_followed(context_.model, work, here());
  release_parted_blocks();
  if (is_due(watch_every)) {
    look_over();
    look_at_sliding();
  }
  if (!work.resolved.flows.empty() && (is_due(in_water(work.resolved) ? water_every : flow_every) ||
                                       water_is_old(work.resolved, context_.state.time))) {
    see_whole();
    refresh_flows(context_.model, context_.state, work.resolved);
    update_external(work.resolved, context_.state.time, moving());
  }
  if (context_.log.due(context_.state.step))
    sample();
  if (is_due(look_every) && !context_.log.watches.empty()) {
    see_whole();
    look_at_units(context_.model, context_.state, context_.conditions, context_.log);
  }
  progress_.times.end(StepLine::watch);
  poll();
}

void Stage::record_step() {
  const Model& model = context_.model;
  EnergyLedger& spent = context_.state.spent;
  broken_.in_step = std::exchange(broken_.between, 0);
  broken_.in_step += record_bond_breaks(model, context_.state, work, context_.log, context_.number, step - 1);
  broken_.in_step += record_face_breaks(model, context_.state, work, context_.log, context_.number, step - 1);
  broken_.in_step +=
      record_begun_cracks(model, context_.state, begun_, context_.log, context_.number, step - 1);
  begun_ = {};
  spent.external += report.sums.external;
  spent.external_peak = std::max(spent.external_peak, std::abs(spent.external));
  spent.damping += report.sums.damping;
  spent.radiated += report.sums.radiated;
  spent.fictitious += report.sums.fictitious;
  context_.log.one_way.look(spent, context_.state.time);
}

void Stage::release_parted_blocks() {
  if (context_.model.frames.empty() || !is_due(release_every))
    return;
  see_whole();
  Released released = release_interfaces(context_.model, context_.state, context_.threads);
  slid_ = std::move(released.slid);
  if (released.interfaces > 0 || !context_.state.water_pressure.empty())
    find_idle_springs(context_.model, context_.state, work.bond);
  context_.state.spent.breaking += released.stored;
  context_.state.spent.external += released.water;
  work.contact.search.fragments_due = work.contact.search.fragments_due || released.interfaces > 0;
  for (std::size_t block = 0; block < work.contact.search.told_due.size(); ++block)
    work.contact.search.told_due[block] |= released.blocks[block];
}

void Stage::poll() {
  if (step % poll_every == 0) {
    CheckpointWriter* const checkpoints = context_.checkpoints;
    if (context_.observer.stop_requested()) {
      if (checkpoints)
        checkpoints->write(true);
      throw Interrupted();
    }
    if (checkpoints && checkpoints->wanted())
      checkpoints->write(false);
    if (progress_.due())
      tell(false);
    show();
  }
  if (step == 1 || (context_.from && step == context_.from->step + 1))
    tell(false);
}

void Stage::show() {
  if (!context_.observer.wants_view())
    return;
  PictureWish wish;
  wish.field = context_.observer.wanted_field();
  ranks().broadcast(wish.field); // rank 0 draws
  const SynchronisedView view(*this,
                              needs_whole(wish) ? SynchronisedView::Of::whole : SynchronisedView::Of::shares);
  Snapshot shown = make_picture_snapshot(context_.model, context_.state, wish, "");
  if (!ranks().leads())
    return;
  add_water(context_.conditions, wish.water, shown);
  context_.observer.view(shown);
}

StageResult Stage::finish() {
  look_over();
  see_whole();
  look_at_units(context_.model, context_.state, context_.conditions, context_.log);
  sample();
  progress_.times.end(StepLine::watch);
  tell(true);
  if (!kept_end_)
    keep_last_good(); // last: whoever ends a stage before goes on from the restart point and the state that stood there
  keep_work();
  watch_.keep(context_.model);
  return {step, report.residual, context_.log.broken_tension - broken_.tension_before,
          context_.log.broken_shear - broken_.shear_before, progress_.wall_time()};
}

// Several ranks would each keep a share, and shares change.
void Stage::keep_work() {
  if (!context_.kept || !work.shared->alone())
    return;
  const auto kept = std::make_shared<KeptWork>();
  kept->tet_contacts = work.contact.tet_contacts;
  if (kept->tet_contacts)
    kept->model = fingerprint(context_.model);
  if (contacts_as_kept_)
    kept->end = {std::move(work.bond), std::move(work.contact), std::move(contacts_), stable, tets_by_place_};
  *context_.kept = kept;
}

void Stage::sample_start() {
  RunLog& log = context_.log;
  if (!log.history.empty() && log.history.back().stage == context_.number)
    return; // a stage of several loops, or one that goes on
  std::optional<SynchronisedView> view;
  if (!begins_ && !context_.log.probes.empty())
    view.emplace(*this, SynchronisedView::Of::whole);
  see_whole();
  record_history(context_, 0, kinetic_energy(context_.model, context_.state), tets_by_place_);
  sampled_start_ = true;
}

void Stage::sample() {
  std::optional<SynchronisedView> view;
  if (!context_.log.probes.empty())
    view.emplace(*this, SynchronisedView::Of::whole);
  else if (!context_.state.water_pressure.empty())
    see_whole();
  record_history(context_, report.residual, report.sums.kinetic, tets_by_place_);
}

void Stage::tell(bool last) {
  Progress progress = report.goals;
  progress.step = step;
  progress.residual = report.residual;
  progress.time = context_.state.time;
  if (details)
    details(progress);
  shares_.add_to(progress);
  progress_(std::move(progress), last);
}

void Stage::see_whole() {
  work.shared->gather(context_.state);
}

void Stage::gather_carried() {
  for (std::vector<Node>* of_nodes : carried)
    work.shared->shares().gather_nodes(*of_nodes);
}

void Stage::see_surfaces(std::vector<Node>& by_node) {
  work.shared->gather_surfaces(context_.state);
  work.shared->shares().gather_nodes(by_node);
}

} // namespace cdem
