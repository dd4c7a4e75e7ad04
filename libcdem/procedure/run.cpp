#include "libcdem/procedure/run.hpp"

#include "libcdem/bond/contact_damping.hpp"
#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/contact/response/contact_bounds.hpp"
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/integrate/move_columns.hpp"
#include "libcdem/integrate/move_held_nodes.hpp"
#include "libcdem/integrate/move_rigid.hpp"
#include "libcdem/integrate/row_sums.hpp"
#include "libcdem/integrate/viscous_forces.hpp"
#include "libcdem/procedure/scaled_stage.hpp"
#include "libcdem/ranks/ranks.hpp"
#include "libcdem/state/places.hpp"
#include "libcdem/step/step.hpp"
#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

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
  const double most = model.surface.joint.empty() ? infinite : most_rigid_time_step(model);
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

// Some springs are contacts, if only with the share that is broken.
bool any_dry_joint(const Model& model, const State& state) {
  const auto is_dry = [&](const Interface& interface) {
    int p = interface.point_begin;
    while (p < interface.point_end && broken_share(state, p) == 0)
      ++p;
    return !released(state, interface) && p < interface.point_end;
  };
  const bool any = std::any_of(model.interfaces.begin(), model.interfaces.end(), is_dry);
  return state.bond_damage.empty() ? any : ranks().any(any); // a rank knows the damage of its own springs
}

class Run final : public Procedure {
public:
  Run(const StageContext& context, const RunOptions& options, const std::string& kind)
      : context_(context), model_(context.model), options_(options), kind_(kind),
        state_(context.state), stepping_{context.from ? Clock(context.from->loop_state).time_step()
                                                      : choose_first_step(context, options),
                                         0, options.local_damping, options.damp_flight},
        stage_(context, kind, run_away_lengths * model_.length),
        scaled_(context,
                !options.mass_scaling.on() ? 0
                : context.from             ? context.from->loop_state.back()
                                           : stepping_.time_step,
                options.safety),
        clock_(state_.time, stepping_.time_step, options) {
    stage_.breaking = options.breaking;
    stage_.safety = options.safety;
    stage_.step_is_given = options.time_step > 0;
    stage_.follows_fragments = options.follows_fragments;
    stage_.escapes = {left_lengths * model_.length,
                      (options.holds_what_left ? left_lengths : run_away_lengths) * model_.length};
    stage_.details = options.details;
    stage_.work.contact.options.most_friction = options.most_friction;
    stage_.work.contact.options.looks_at_all = options.looks_at_all_contacts;
    stage_.work.damped = !state_.viscous_stress.empty();
    stage_.looks = options.looks;
    if ((options.callback && options.callback_every > 0) || options.stop)
      stage_.looks.insert(stage_.looks.begin(),
                          {options.callback_every > 0 ? options.callback_every : 100, 0, [this] { ask(); }});
    if (context.from) {
      clock_ = Clock(context.from->loop_state);
      if (context.from->step == 0)
        clock_.set_goal(state_.time, options);
      else
        scaled_.take(context.from->loop_state);
    }
    if (stage_.stable == 0)
      find_stable_step();
    set_goals();
    lead_supports();
    stage_.sample_start();
    if (scaled_.on())
      stage_.scale_masses = [this] { scaled_.scale(); };
    else if (!context.from || state_.moving_mass.empty()) // otherwise it goes on
      stage_.carry_water(stage_.work.resolved.water_mass);
  }

  RunResult solve() {
    stage_.make_steps(*this);
    if (!context_.procedure_state)
      stage_.keep_end(numbers(stage_.step));
    if (!scaled_.on())
      stage_.carry_water({});
    RunResult result{stage_.finish(), state_.time, stepping_.time_step, {}};
    if (scaled_.on()) {
      if (!stage_.is_due(watch_every))
        scaled_.sample();
      result.scaled = scaled_.report();
    }
    return result;
  }

  bool is_over() const override { return stage_.step >= clock_.steps() || stopped_; }
  double time_step() const override { return stepping_.time_step; }
  std::vector<double> loop_state() override { return numbers(0); }

  void begin_step(bool changed, bool joined) override {
    if (changed) {
      const double before = stepping_.time_step;
      viscous_ = viscous_forces(model_);
      find_stable_step();
      stable_of_mesh_ = stable_of_mesh();
      if (joined && options_.time_step == 0 && !scaled_.on())
        take_step(choose_time_step(context_, options_));
      if (!scaled_.on())
        shorten(options_.safety * stable_of_mesh_);
      if (stepping_.time_step < 0.5 * before)
        context_.observer.message(
            fmt::format("the time step fell from {:.3g} to {:.3g} s: faces that crack are stiff", before,
                        stepping_.time_step));
    }
    BondWork& bond = stage_.work.bond;
    if ((changed || stage_.begins() || stage_.is_due(watch_every)) && any_dry_joint(model_, state_)) {
      bond.add_dashpots();
      if (options_.time_step == 0 && !scaled_.on())
        shorten(options_.safety * stable_step_of_dry_joints(stage_.stable));
    }
    bond.contact_damping =
        bond.viscous.empty()
            ? 0
            : contact_damping(stepping_.time_step,
                              scaled_.on() ? stepping_.time_step / options_.safety : stage_.stable);
  }

  void take_contacts(double longest) override {
    if (options_.time_step == 0) // else impacts are as coarse as the step that the user has chosen
      longest = std::min(longest,
                         stage_.longest_step_of_flight(options_.local_damping != 0 || !options_.damp_flight));
    if (has_crack_pressure_)
      longest = std::min(longest, options_.safety * stage_.update_crack_pressures(stable_of_mesh_));
    shorten(longest);
  }

  void update_loads() override {
    lead_supports();
    // Velocities that stand at the time of the displacements, at the start or after a relaxation, take half a step.
    stepping_.kick = state_.velocity_lag + 0.5 * stepping_.time_step;
    stage_.update_loads(&stepping_);
    stage_.work.bond.damping_step = stepping_.time_step;
  }

  void move(Range range, const Node* force, NodeSums& sums) override {
    carry_water(range, [&](std::int64_t i, double more) {
      sums.external += 0.5 * more * vec(state_.velocity[i]).squaredNorm();
    });
    const auto nodes = [&](Range part) {
      MovingNodes moving = moving_nodes(state_, stage_.work.acting(), moving_mass(model_, state_), part,
                                        force + (part.begin - range.begin));
      moving.viscous = viscous_.empty() ? nullptr : viscous_.data() + part.begin;
      return moving;
    };
    step_nodes_and_held(stage_.work.resolved, range, nodes, stepping_, sums);
  }
  void move_rigid(int rigid, NodeSums& sums) override {
    double more = 0; // kg
    carry_water(nodes_of(rigid), [&](std::int64_t, double of_node) { more += of_node; });
    sums.external += 0.5 * more * cdem::vec(state_.rigid[rigid].velocity).squaredNorm();
    stage_.work.rigid_angle[rigid] =
        cdem::move_rigid(model_, state_, stage_.work.acting(), rigid, stepping_, sums);
  }
  void place_rigid(int rigid) override {
    carry_water(nodes_of(rigid), [](std::int64_t, double) {}); // another rank may have moved it
    cdem::place_rigid(model_, state_, rigid, stage_.work.rigid_angle[rigid], stepping_.time_step);
  }

  void end_step() override {
    state_.time = clock_.time_at(stage_.step);
    state_.velocity_lag = 0.5 * stepping_.time_step;
  }

  void judge() override {
    if (!scaled_.on() || !stage_.is_due(watch_every))
      return;
    stage_.see_whole();
    scaled_.sample();
  }

private:
  // The water that moves with nodes now takes the place of what did: add(node, kg more).
  template <class Add>
  void carry_water(Range nodes, const Add& add) {
    const std::vector<double>& water = stage_.work.resolved.water_mass;
    for (std::int64_t i = nodes.begin; i < nodes.end && !water.empty(); ++i) {
      const double mass = model_.node_mass[i] + water[i];
      add(i, mass - std::exchange(state_.moving_mass[i], mass));
    }
  }
  Range nodes_of(int rigid) const {
    const Block& block = model_.blocks[model_.rigid[rigid].block];
    return {block.node_begin, block.node_end};
  }

  void ask() {
    if (options_.callback && options_.callback_every > 0)
      options_.callback();
    stopped_ = options_.stop && options_.stop() && stage_.report.residual <= options_.stop_residual;
  }

  std::vector<double> numbers(std::int64_t step) const {
    std::vector<double> numbers = clock_.loop_state(step);
    scaled_.add_to(numbers);
    return numbers;
  }

  void set_goals() {
    // What only `stop` ends has no goal to tell of.
    const std::int64_t steps = clock_.steps();
    if (steps == std::numeric_limits<std::int64_t>::max())
      return;
    Progress& goals = stage_.report.goals;
    goals.max_steps = steps;
    goals.time_goal = clock_.time_at(steps);
    goals.time_start =
        goals.time_goal -
        (options_.duration > 0 ? options_.duration : static_cast<double>(steps) * clock_.time_step());
  }

  // Supports with a given displacement are there at the end. They are led anew in every step, so that where the stage can be
  // left, or the model changes, does not matter.
  void lead_supports() {
    ResolvedConditions& r = stage_.work.resolved;
    if (!r.has_target)
      return;
    const bool has_end =
        clock_.steps() < std::numeric_limits<std::int64_t>::max() && !options_.holds_what_left;
    if (has_end)
      aim_supports(model_, state_, r, clock_.time_at(clock_.steps()) - clock_.time_at(stage_.step));
    else if (longest_way(model_, state_, r) > 0)
      throw geom::InputError("displacement of fix: " + kind_ +
                             " has no set end at which the support could be there; move it by model:relax or "
                             "model:run before, or give velocity");
  }

  double stable_of_mesh() const { return stable_time_step(model_, stage_.work.resolved.bolts); }
  void find_stable_step() { // rigid bodies take half of their stable step at most
    if (model_.points.empty())
      return;
    stage_.stable = stable_of_mesh();
    if (!model_.surface.empty())
      stage_.stable = std::min(stage_.stable, 2 * rigid_time_step(model_, 1));
  }
  void take_step(double time_step) {
    stepping_.time_step = time_step;
    clock_.go_on_with(stage_.step, time_step);
    set_goals();
  }
  void shorten(double longest) {
    if (longest < stepping_.time_step)
      take_step(longest);
  }

  const StageContext& context_;
  const Model& model_;
  const RunOptions& options_;
  const std::string& kind_;
  State& state_;
  Stepping stepping_;
  Stage stage_;
  ScaledStage scaled_;
  Clock clock_;
  std::vector<double> viscous_ = viscous_forces(model_);
  const bool has_crack_pressure_ = !context_.conditions.crack_pressures.empty();
  // s; only where a fluid in a crack asks for it: it reads the whole model, whose other parts a rank has given back.
  double stable_of_mesh_ = has_crack_pressure_ ? stable_of_mesh() : 0;
  bool stopped_ = false;
};

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
  return Run(context, options, kind).solve();
}

} // namespace cdem
