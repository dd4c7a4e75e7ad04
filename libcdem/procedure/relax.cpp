#include "libcdem/procedure/relax.hpp"

#include "libcdem/integrate/move_held_nodes.hpp"
#include "libcdem/integrate/move_rigid.hpp"
#include "libcdem/procedure/fictitious_masses.hpp"
#include "libcdem/procedure/settled.hpp"
#include "libcdem/procedure/slow_mode.hpp"
#include "libcdem/procedure/stability.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/step/errors.hpp"
#include "libcdem/step/synchronised_view.hpp"
#include "libgeom/core/error.hpp"

#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace cdem {
namespace {

// Weight of a step's Rayleigh quotient in the smoothed one.
constexpr double smoothing = 0.05;
constexpr double most_damping = 1.8;
// Supports with a given displacement get there in this many steps.
constexpr int support_steps = 200;
// Without loads the residual is measured against the reactions. Moved supports that have torn their part off, and a free
// body that springs back from its initial stress, leave none: then against this fraction of the largest reaction of the
// stage or of the forces of the initial stress (squared norms).
constexpr double reaction_floor2 = 1e-4;

// In the steps that are left to them; then they stand.
void lead_supports(const State& state, ResolvedConditions& r, std::int64_t step) {
  for (HeldNode& h : r.held)
    h.prescribed = {};
  if (r.has_target && step < support_steps)
    aim_supports(state, r, support_steps - static_cast<int>(step));
}

// Squared norm of the initial stress's forces on free components, N2.
double initial_stress_forces2(const ResolvedConditions& r) {
  double sum = 0;
  const auto add = [&](const Node& f, const Node& free) {
    const double x = free.x * f.x, y = free.y * f.y, z = free.z * f.z;
    sum += x * x + y * y + z * z;
  };
  each_node(
      r, {0, static_cast<std::int64_t>(r.internal.size())},
      [&](Range free) {
        for (std::int64_t i = free.begin; i < free.end; ++i)
          add(r.internal[i], {1, 1, 1, 0});
      },
      [&](const HeldNode& h) { add(r.internal[h.node], h.free); });
  return sum;
}

// Rigid bodies have no stiffness to find a balance with.
void require_held(const Model& model, const ResolvedConditions& r) {
  for (std::size_t i = 0; i < model.rigid.size(); ++i)
    if (!r.rigid[i]) {
      const Block& block = model.blocks[model.rigid[i].block];
      throw geom::InputError(
          fmt::format("relax: block {} of body \"{}\" is rigid and free; hold it, use run or settle, "
                      "or make it deformable",
                      block.id, model.bodies[block.body].name));
    }
}

// Looks every watch_every steps of the model, where the state has just been caught up.
class Stability {
public:
  Stability(const Model& model, const State& state, const std::vector<double>& mass,
            std::int64_t moving_steps)
      : model_(model), state_(state), watch_(slowest_period(model, mass), model.length, moving_steps),
        displacement_(state.displacement) {}

  void look(std::int64_t step, double residual) {
    const EnergyLedger ledger = energy(model_, state_);
    fastest_ = fastest(displacement_, state_.displacement);
    displacement_ = state_.displacement;
    path_ += fastest_.displacement;
    watch_.add({step, path_, residual, ledger.external, ledger.elastic + ledger.springs});
  }
  void renumbered() { displacement_ = state_.displacement; }
  const StabilityWatch& watch() const { return watch_; }
  void describe(RelaxResult& result) const {
    result.moving = fastest_.displacement;
    result.moving_block = model_.blocks[block_of(model_, fastest_.node)].id;
    result.moving_place = model_.node_position[fastest_.node];
  }

  void add_to(std::vector<double>& loop_state) const {
    loop_state.insert(loop_state.end(), {path_, static_cast<double>(fastest_.node), fastest_.displacement});
    watch_.add_to(loop_state);
  }
  void take(const std::vector<double>& loop_state, std::size_t from) {
    path_ = loop_state.at(from);
    const double node = loop_state.at(from + 1);
    const bool there = node >= 0 && node < static_cast<double>(displacement_.size());
    fastest_ = {there ? static_cast<int>(node) : 0, loop_state.at(from + 2)};
    watch_.take(loop_state, from + 3);
  }

private:
  const Model& model_;
  const State& state_;
  StabilityWatch watch_;
  std::vector<Node> displacement_; // m, at the last look (n_nodes)
  double path_ = 0;                // m, of the fastest node
  Fastest fastest_;
};

// Dashpots carry nothing at rest.
void require_no_quiet(const Conditions& conditions) {
  if (!conditions.quiets.empty() || !conditions.free_fields.empty())
    throw geom::InputError(
        "relax: quiet boundaries and free fields hold nothing in a relaxation; find the static "
        "balance with model:fix there, then call model:quiet and model:free_field");
}

// The masses of a relaxation are those of the elements' stiffness, not of a fluid's.
void require_given_pressures(const Conditions& conditions) {
  for (const CrackPressure& pressure : conditions.crack_pressures)
    if (pressure.volume)
      throw geom::InputError("volume", "a pumped fluid in a relaxation", "in model:run",
                             "let a run with local_damping come to rest, or give its pressure here");
}

void stop(State& state) {
  std::fill(state.velocity.begin(), state.velocity.end(), Node{});
  for (RigidState& rigid : state.rigid)
    rigid.velocity = rigid.angular_momentum = {};
}

// However a relaxation ends, it leaves the state at rest: its velocities are lengths per step of fictitious masses.
struct AtRest {
  Stage& stage;
  State &state, &last_good;
  const NodeSums& sums;
  ~AtRest() {
    stage.synchronise();
    state.spent.fictitious += sums.kinetic;
    stop(state);
    stop(last_good);
  }
};

} // namespace

RelaxResult relax(const StageContext& context, const RelaxOptions& options, const std::string& kind) {
  State& state = context.state;
  require_no_quiet(context.conditions);
  require_given_pressures(context.conditions);
  require_held(context.model, resolve(context.model, state, context.conditions));
  Stage stage(context, kind, context.model.length);
  stage.work.contact.restitution = false; // its steps are no times
  stage.in_real_time = false;
  FictitiousMasses masses(context.model, stage.work.resolved.bolts);
  const RestartPoint* const from = context.from;
  std::vector<Node> previous_force(masses.of_nodes().size()); // N, of the step before
  stage.carried = &previous_force;
  update_external(stage.work.resolved, state.time);
  if (from) {
    previous_force = from->previous_force;
  } else {
    const double moving = energy(context.model, state).total();
    stop(state);
    std::fill(state.viscous_stress.begin(), state.viscous_stress.end(), StressBatch{});
    state.velocity_lag = 0;
    state.spent.fictitious += moving - energy(context.model, state).total();
  }
  lead_supports(state, stage.work.resolved, stage.step);
  const int moving_steps = stage.work.resolved.has_target ? support_steps : 0;

  // Without supports nothing could hold the model: a mistake, that ends with an error.
  const bool judges = !stage.work.resolved.held.empty();
  Stability stability(context.model, state, masses.of_nodes(), moving_steps);
  bool failing = false, converged = false;
  Stage::StepReport report;
  report.goals.note = options.note;
  report.goals.trial = !options.note.empty();
  report.goals.residual_goal = options.residual;
  report.goals.max_steps = options.max_steps;
  bool forces_known = stage.step > 0; // of the step before
  double lambda = 0, damping = 0, largest_reaction2 = initial_stress_forces2(stage.work.resolved);
  Settled settled(options.residual);
  SlowMode slow;
  if (from) {
    lambda = from->loop_state.at(0);
    damping = from->loop_state.at(1);
    largest_reaction2 = from->loop_state.at(2);
    report.sums.kinetic = from->loop_state.at(3);
    forces_known = from->loop_state.at(4) != 0;
    slow.take(from->loop_state.at(5));
    if (forces_known && stage.step > moving_steps)
      slow.start(state, previous_force);
    stability.take(from->loop_state, masses.take(from->loop_state, settled.take(from->loop_state, 6)));
  }
  const auto loop_state = [&] {
    std::vector<double> numbers{lambda,
                                damping,
                                largest_reaction2,
                                report.sums.kinetic,
                                forces_known ? 1.0 : 0.0,
                                slow.frequency2().value_or(-1)};
    settled.add_to(numbers);
    masses.add_to(numbers);
    stability.add_to(numbers);
    return numbers;
  };
  RelaxResult result;
  double kept_kinetic = report.sums.kinetic; // J, of the state that was kept last
  const auto step = [&] {
    const bool renewed = stage.renew_interfaces(),
               freed = (options.breaking && stage.split_nodes(1)) || renewed;
    if (freed) {
      masses = FictitiousMasses(context.model, stage.work.resolved.bolts);
      previous_force.assign(masses.of_nodes().size(), {});
      forces_known = false;
      slow.forget();
      stability.renumbered();
    }
    if (freed || stage.can_be_left()) {
      stage.keep_restart_point(loop_state(), previous_force);
      kept_kinetic = report.sums.kinetic;
    }
    if (freed || stage.step <= moving_steps)
      lead_supports(state, stage.work.resolved, stage.step);
    stage.update_contacts();
    masses.follow(context.model, stage.work.contact);
    stage.update_loads_at_rest();
    const auto move = [&](Range range, const Node* force, NodeSums& sums) {
      const auto nodes = [&](Range part) {
        return moving_nodes(state, stage.work.acting(), masses.of_nodes(), part,
                            force + (part.begin - range.begin));
      };
      each_node(
          stage.work.resolved, range,
          [&](Range part) { relax_nodes(nodes(part), damping, previous_force.data() + part.begin, sums); },
          [&](const HeldNode& h) {
            relax_held_node(nodes({h.node, h.node + 1}), h, damping, previous_force[h.node], sums);
          });
    };
    report.sums = stage.advance(options.breaking, move, [&](int rigid, NodeSums& sums) {
      hold_rigid(context.model, state, stage.work.acting(), rigid, sums);
    });
    stage.end_step(1); // velocities are lengths per step
    largest_reaction2 = std::max(largest_reaction2, report.sums.reaction2);
    report.sums.reaction2 = std::max(report.sums.reaction2, reaction_floor2 * largest_reaction2);
    report.residual = relative_residual(report.sums);
    stage.watch(report);
    if (judges && stage.is_due(watch_every)) {
      stage.see_whole();
      stability.look(stage.step, report.residual);
      failing = stability.watch().failing();
    }

    if (report.sums.inertia > 0 && (forces_known || stage.step <= 1)) {
      const double quotient = std::max(0.0, report.sums.stiffness / report.sums.inertia);
      lambda += (stage.step < 3 ? 1.0 : smoothing) * (quotient - lambda);
    }
    forces_known = true;
    if (stage.step > moving_steps && stage.is_due(slow_mode_every)) {
      stage.see_surfaces(previous_force);
      slow.look(state, previous_force, masses.of_nodes());
    }
    damping = std::min(2 * std::sqrt(std::min(lambda, slow.frequency2().value_or(lambda))), most_damping);
    if (stage.broken_in_step() == 0 && stage.step > moving_steps)
      settled.add(report.residual);
    else
      settled.start_anew();
    converged = settled.reached(0.5 * damping);
    if (options.callback && options.callback_every > 0 && stage.step % options.callback_every == 0) {
      const SynchronisedView view(stage, SynchronisedView::Of::shares); // what it reads is of one moment
      options.callback();
      view.require_same_looks();
    }
    look(stage, options.looks, state.time, state.time);
  };
  {
    const AtRest at_rest{stage, state, context.last_good, report.sums};
    try {
      while (stage.step < options.max_steps && !converged && !(failing && options.stop_on_failure))
        step();
    } catch (const SolutionError&) {
      if (!options.stop_on_failure || !stability.watch().suspicious())
        throw;
      // It ran too far between two looks: what is kept is the last one.
      stage.go_back();
      report.sums.kinetic = kept_kinetic;
      failing = true;
    }
  }
  static_cast<StageResult&>(result) = stage.finish(report);
  result.converged = converged;
  result.verdict = result.converged ? Verdict::stable : failing ? Verdict::failing : Verdict::undecided;
  stability.describe(result);
  return result;
}

} // namespace cdem
