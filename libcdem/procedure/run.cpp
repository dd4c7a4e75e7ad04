#include "libcdem/procedure/run.hpp"

#include "libcdem/bond/contact_damping.hpp"
#include "libcdem/contact/response/contact_bounds.hpp"
#include "libcdem/integrate/move_columns.hpp"
#include "libcdem/integrate/move_held_nodes.hpp"
#include "libcdem/integrate/move_rigid.hpp"
#include "libcdem/integrate/row_sums.hpp"
#include "libcdem/integrate/viscous_forces.hpp"
#include "libcdem/joint/bond_mode.hpp"
#include "libcdem/procedure/scaled_stage.hpp"
#include "libcdem/step/synchronised_view.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace cdem {
namespace {

// Distance from the model's box, over its size: beyond it a piece has left the model, or has run away if it is the only
// one.
constexpr double left_lengths = 1, run_away_lengths = 100;

double choose_time_step(const StageContext& context, const RunOptions& options) {
  const Model& model = context.model;
  const double stable =
                   stable_time_step(model, resolve_bolts(model, context.state, context.conditions.bolts)),
               infinite = std::numeric_limits<double>::infinity();
  require_scalable(model, options);
  if (options.mass_scaling.on()) { // the masses follow the step, but those of rigid bodies
    const double asked = options.mass_scaling.step > 0
                             ? options.mass_scaling.step
                             : options.mass_scaling.factor * options.safety * stable;
    return model.surface.empty() ? asked : std::min(asked, rigid_time_step(model, options.safety));
  }
  // Rigid bodies have a stable step only where they may touch.
  const double touching = model.surface.empty() ? infinite
                                                : std::min(rigid_time_step(model, options.safety),
                                                           closing_time_step(model, options.safety));
  const double usual = std::min(options.safety * stable, touching);
  if (options.time_step == 0 && std::isinf(usual))
    throw geom::InputError(
        "time_step: missing; everything that moves is rigid and touches nothing, which has no "
        "stable step to take: give one (s)");
  if (options.time_step > stable)
    throw geom::InputError("time_step", fmt::format("{:g}", options.time_step),
                           fmt::format("at most the stable step, {:.4g} s", stable),
                           "leave it out to use safety x stable");
  const double most = model.surface.joint.empty() ? infinite : rigid_time_step(model, 1);
  if (options.time_step > most)
    throw geom::InputError(
        "time_step", fmt::format("{:g}", options.time_step),
        fmt::format("at most {:.4g} s, half the stable step of rigid bodies that touch", most),
        "leave it out to use the usual one");
  return options.time_step > 0 ? options.time_step : usual;
}

void require_columns_stable(const ResolvedConditions& r, double time_step) {
  if (const double stable = column_time_step(r); time_step > stable)
    throw geom::InputError(
        "time_step", fmt::format("{:.4g}", time_step),
        fmt::format("at most {:.4g} s, the stable step of the free field's columns", stable),
        "name a time_step below it");
}

// Before the stage, which nothing refuses any more.
double choose_first_step(const StageContext& context, const RunOptions& options) {
  const double time_step = choose_time_step(context, options);
  const ResolvedConditions resolved = resolve(context.model, context.state, context.conditions);
  require_columns_stable(resolved, time_step);
  if (options.mass_scaling.on() && !resolved.water_mass.empty())
    throw geom::InputError(
        "mass_scaling: not beside a flow with added_mass, which is inertia too; leave one out");
  return time_step;
}

// The time of each step of a run whose step may get shorter as contacts close.
class Clock {
public:
  Clock(double start, double time_step, const RunOptions& options)
      : start_(start), end_(start + options.duration), time_step_(time_step), given_(options.steps) {
    set_steps();
  }
  // As it was when loop_state() was called.
  explicit Clock(const std::vector<double>& c)
      : start_(c.at(0)), end_(c.at(1)), time_step_(c.at(2)),
        given_(c.at(3) < 0 ? without_end : static_cast<std::int64_t>(c.at(3))),
        first_(static_cast<std::int64_t>(c.at(4))) {
    set_steps();
  }
  // step: that other stage calls its first step 0.
  std::vector<double> loop_state(std::int64_t step = 0) const {
    return {start_, end_, time_step_, given_ == without_end ? -1 : static_cast<double>(given_),
            static_cast<double>(first_ - step)};
  }
  void set_goal(double now, const RunOptions& options) {
    end_ = now + options.duration;
    given_ = options.steps;
    set_steps();
  }
  double time_step() const { return time_step_; }
  std::int64_t steps() const { return steps_; }
  double time_at(std::int64_t step) const { return start_ + static_cast<double>(step - first_) * time_step_; }
  void go_on_with(std::int64_t step, double time_step) {
    start_ = time_at(step);
    first_ = step;
    time_step_ = time_step;
    set_steps();
  }

private:
  void set_steps() {
    steps_ = given_ > 0 ? given_
                        : first_ + static_cast<std::int64_t>(std::ceil((end_ - start_) / time_step_ - 1e-9));
  }
  static constexpr std::int64_t without_end = std::numeric_limits<std::int64_t>::max();
  double start_, end_, time_step_;
  std::int64_t given_, first_ = 0, steps_ = 0;
};

// Some springs of interfaces that turn are contacts: never bonded, or broken.
bool any_dry_joint(const Model& model, const State& state) {
  return std::any_of(model.interfaces.begin(), model.interfaces.end(), [&](const Interface& interface) {
    const auto mode = state.bond_mode.begin();
    return interface.frame >= 0 && state.released[interface.frame] == 0 &&
           !std::all_of(mode + interface.point_begin, mode + interface.point_end, is_intact);
  });
}

} // namespace

double stable_time_step(const Model& model, const std::vector<ResolvedBolt>& bolts) {
  std::vector<double> sums = all_row_sums(model);
  add_bolt_row_sums(bolts, sums);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(sums.size()); ++i)
    if (const Block& block = model.blocks[block_of(model, i)]; block.rigid < 0) {
      const double frequency2 = sums[i] / model.node_mass[i];
      least =
          std::min(least, stable_time_step(frequency2, block.meshed ? damping_of(model, i) * frequency2 : 0));
    }
  return least;
}

RunResult run(const StageContext& context, const RunOptions& options, const std::string& kind) {
  State& state = context.state;
  const RestartPoint* const from = context.from;
  Stepping stepping{from ? Clock(from->loop_state).time_step() : choose_first_step(context, options), 0,
                    options.local_damping, options.damp_flight};
  Stage stage(context, kind, run_away_lengths * context.model.length);
  ScaledStage scaled(context,
                     !options.mass_scaling.on() ? 0
                     : from                     ? from->loop_state.back()
                                                : stepping.time_step,
                     options.safety);
  stage.follows_fragments = options.follows_fragments;
  stage.escapes = {left_lengths * context.model.length,
                   (options.holds_what_left ? left_lengths : run_away_lengths) * context.model.length};
  stage.details = options.details;
  stage.work.contact.most_friction = options.most_friction;
  stage.work.contact.looks_at_all = options.looks_at_all_contacts;
  stage.work.damped = !state.viscous_stress.empty();
  std::vector<double> viscous = viscous_forces(context.model);
  Stage::StepReport report;
  Clock clock(state.time, stepping.time_step, options);
  if (from) {
    clock = Clock(from->loop_state);
    if (from->step == 0)
      clock.set_goal(state.time, options);
    else
      scaled.take(from->loop_state);
  }
  const auto set_goals = [&] {
    // What only `stop` ends has no goal to tell of.
    if (clock.steps() < std::numeric_limits<std::int64_t>::max()) {
      report.goals.max_steps = clock.steps();
      report.goals.time_goal = clock.time_at(clock.steps());
      report.goals.time_start =
          report.goals.time_goal -
          (options.duration > 0 ? options.duration : static_cast<double>(clock.steps()) * clock.time_step());
    }
  };
  set_goals();
  // Supports with a given displacement are there at the end. They are led anew in every step, so that where the stage can be
  // left, or the model changes, does not matter.
  const auto lead_supports = [&] {
    ResolvedConditions& r = stage.work.resolved;
    if (!r.has_target)
      return;
    const bool has_end = clock.steps() < std::numeric_limits<std::int64_t>::max() && !options.holds_what_left;
    if (has_end)
      aim_supports(state, r, clock.time_at(clock.steps()) - clock.time_at(stage.step));
    else if (has_way_to_go(context.model, state, r))
      throw geom::InputError("displacement of fix: " + kind +
                             " has no set end at which the support could be there; move it by model:relax or "
                             "model:run before, or give velocity");
  };
  lead_supports();
  stage.sample_start();
  const auto loop_state = [&](std::int64_t step) {
    std::vector<double> numbers = clock.loop_state(step);
    scaled.add_to(numbers);
    return numbers;
  };
  if (scaled.on())
    stage.scale_masses = [&] { scaled.scale(); };
  else
    stage.carry_water();
  // Where damping takes the energy anyway, and where the user has chosen the step, impacts are as coarse as the step.
  const bool keeps_energy_of_impacts =
      options.local_damping == 0 && options.damp_flight && options.time_step == 0;
  const std::int64_t ask_every = options.callback_every > 0 ? options.callback_every : 100;

  const auto stable_of_all = [&] { // s; rigid bodies take half of their stable step at most
    const double stable = stable_time_step(context.model, stage.work.resolved.bolts);
    return context.model.surface.empty() ? stable : std::min(stable, 2 * rigid_time_step(context.model, 1));
  };
  double stable_now = context.model.frames.empty() ? 0 : stable_of_all();
  const bool chooses_step = options.time_step == 0 && !scaled.on() && !context.model.frames.empty();
  const auto take_step = [&](double time_step) {
    stepping.time_step = time_step;
    clock.go_on_with(stage.step, time_step);
    set_goals();
  };
  const auto shorten = [&](double longest) {
    if (longest >= stepping.time_step)
      return false;
    take_step(longest);
    return true;
  };
  // s; only where a fluid in a crack asks for it: it reads the whole model, whose other parts a rank has given back.
  const bool has_crack_pressure = !context.conditions.crack_pressures.empty();
  double stable_of_mesh = has_crack_pressure ? stable_time_step(context.model, stage.work.resolved.bolts) : 0;
  bool stopped = false;
  while (stage.step < clock.steps() && !stopped) {
    const bool renewed = stage.renew_interfaces(),
               freed = (options.breaking && stage.split_nodes(stepping.time_step)) || renewed;
    const bool joined = options.breaking && stage.join_nodes();
    if (freed || joined) {
      const double before = stepping.time_step;
      viscous = viscous_forces(context.model);
      stable_now = context.model.frames.empty() ? 0 : stable_of_all();
      stable_of_mesh = stable_time_step(context.model, stage.work.resolved.bolts);
      if (joined && options.time_step == 0 && !scaled.on())
        take_step(choose_time_step(context, options));
      if (!scaled.on())
        shorten(options.safety * stable_of_mesh);
      if (stepping.time_step < 0.5 * before)
        context.observer.message(
            fmt::format("the time step fell from {:.3g} to {:.3g} s: faces that crack are stiff", before,
                        stepping.time_step));
    }
    // Before the restart point, which is where a stage that goes on begins.
    if (chooses_step && (freed || joined || stage.begins() || stage.is_due(watch_every)) &&
        any_dry_joint(context.model, state))
      shorten(options.safety * stable_step_of_dry_joints(stable_now));
    if (freed || joined || stage.can_be_left())
      stage.keep_restart_point(loop_state(0));
    stage.work.bond.contact_damping =
        contact_damping(stepping.time_step, scaled.on() ? stepping.time_step / options.safety : stable_now);
    double longest = stage.update_contacts(options.safety);
    if (keeps_energy_of_impacts)
      longest = std::min(longest, stage.longest_step_of_flight());
    if (has_crack_pressure)
      longest = std::min(longest, options.safety * stage.update_crack_pressures(stable_of_mesh));
    shorten(longest);
    lead_supports();
    // Velocities that stand at the time of the displacements, at the start or after a relaxation, take half a step.
    stepping.kick = state.velocity_lag + 0.5 * stepping.time_step;
    stage.update_loads(state.time, stepping);
    stage.work.bond.damping_step = stepping.time_step;
    const auto move = [&](Range range, const Node* force, NodeSums& sums) {
      const auto nodes = [&](Range part) {
        MovingNodes moving = moving_nodes(state, stage.work.acting(), moving_mass(context.model, state), part,
                                          force + (part.begin - range.begin));
        moving.viscous = viscous.empty() ? nullptr : viscous.data() + part.begin;
        return moving;
      };
      step_nodes_and_held(stage.work.resolved, range, nodes, stepping, sums);
    };
    std::vector<geom::Vec3>& angle = stage.work.rigid_angle;
    report.sums = stage.advance(
        options.breaking, move,
        [&](int rigid, NodeSums& sums) {
          angle[rigid] = move_rigid(context.model, state, stage.work.acting(), rigid, stepping, sums);
        },
        [&](int rigid) { place_rigid(context.model, state, rigid, angle[rigid], stepping.time_step); });
    stage.end_step(stepping.time_step);
    report.residual = relative_residual(report.sums);
    const double before = state.time;
    state.time = clock.time_at(stage.step);
    state.velocity_lag = 0.5 * stepping.time_step;
    stage.watch(report);
    if (scaled.on() && stage.is_due(watch_every)) {
      stage.see_whole();
      scaled.sample();
    }
    if (stage.step % ask_every == 0) {
      std::optional<SynchronisedView> view; // what they read is of one moment
      if (options.callback || options.stop)
        view.emplace(stage, SynchronisedView::Of::shares);
      if (options.callback && options.callback_every > 0) {
        options.callback();
        view->require_same_looks();
      }
      stopped = options.stop && options.stop() && report.residual <= options.stop_residual;
    }
    look(stage, options.looks, before, state.time);
  }
  if (!context.procedure_state)
    stage.keep_end(loop_state(stage.step));
  if (!scaled.on())
    stage.drop_water();
  RunResult result{stage.finish(report), state.time, stepping.time_step, {}};
  if (scaled.on()) {
    if (!stage.is_due(watch_every))
      scaled.sample();
    result.scaled = scaled.report();
  }
  return result;
}

} // namespace cdem
