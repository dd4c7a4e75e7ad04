#include "libcdem/procedure/relax.hpp"

#include "libcdem/bond/spring_forces.hpp"
#include "libcdem/integrate/move_held_nodes.hpp"
#include "libcdem/integrate/move_rigid.hpp"
#include "libcdem/parallel/exact_sum.hpp"
#include "libcdem/procedure/fictitious_masses.hpp"
#include "libcdem/procedure/piece_balance.hpp"
#include "libcdem/procedure/settled.hpp"
#include "libcdem/procedure/slow_mode.hpp"
#include "libcdem/procedure/stability.hpp"
#include "libcdem/procedure/support_way.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/step/errors.hpp"
#include "libcdem/step/step.hpp"
#include "libgeom/core/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

// Weight of a step's Rayleigh quotient in the smoothed one.
constexpr double smoothing = 0.05;
constexpr double most_damping = 1.8;
// Without loads the residual is measured against the reactions. Moved supports that have torn their part off, and a free
// body that springs back from its initial stress, leave none: then against this fraction of the largest reaction of the
// stage or of the forces of the initial stress (squared norms). So is the pace of moved supports.
constexpr double reaction_floor2 = 1e-4;
// Forces that move nodes by this part of the model's length in a step are of rounding, and no reactions either.
constexpr double rounding = 1e-13;

// N2, squared norm; mass: kg for a unit step (n_nodes).
double rounding_forces2(const std::vector<double>& mass, double length) {
  double sum = 0;
  for (const double m : mass)
    sum += m * m;
  return sum * (rounding * length) * (rounding * length);
}

void stop_supports(ResolvedConditions& r) {
  for (HeldNode& h : r.held)
    h.prescribed = {};
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
  Stability(const Model& model, const State& state, double period)
      : model_(model), state_(state), watch_(period, model.length), displacement_(state.displacement) {}

  // has_settled: as a whole.
  void look(std::int64_t step, double residual, const LoosePieces& loose, bool has_settled,
            bool supports_stand) {
    const bool lands = fall_ == Fall::falls && !loose.fall;
    if (has_settled != has_settled_ || lands) {
      watch_.start_anew();
      path_ = 0;
    }
    has_settled_ = has_settled;
    if (lands)
      fall_ = Fall::landed;
    else if (loose.fall && fall_ == Fall::none)
      fall_ = Fall::falls;
    const EnergyLedger ledger = energy(model_, state_);
    fastest_ = fastest(displacement_, state_.displacement, loose.nodes);
    for (std::size_t i = 0; i < loose.nodes.size(); ++i)
      if (!loose.nodes[i]) {
        const Node &to = state_.displacement[i], &from = displacement_[i], &load = loose.load[i];
        work_on_rest_ += load.x * (to.x - from.x) + load.y * (to.y - from.y) + load.z * (to.z - from.z);
      }
    displacement_ = state_.displacement;
    path_ += fastest_.displacement;
    if (!supports_stand)
      watch_.wait(step);
    watch_.add({step, path_, residual * loose.of_residual, ledger.external - work_on_rest_,
                ledger.elastic + ledger.springs - work_on_rest_, fall_ == Fall::falls});
  }
  void renumbered() { displacement_ = state_.displacement; }
  const StabilityWatch& watch() const { return watch_; }
  void describe(RelaxResult& result) const {
    result.moving = fastest_.displacement;
    result.moving_block = model_.blocks[block_of(model_, fastest_.node)].id;
    result.moving_place = model_.node_position[fastest_.node];
  }

  void add_to(std::vector<double>& loop_state) const {
    loop_state.insert(loop_state.end(),
                      {path_, work_on_rest_, has_settled_ ? 1.0 : 0.0, static_cast<double>(fall_),
                       static_cast<double>(fastest_.node), fastest_.displacement});
    watch_.add_to(loop_state);
  }
  void take(const std::vector<double>& loop_state, std::size_t from) {
    path_ = loop_state.at(from);
    work_on_rest_ = loop_state.at(from + 1);
    has_settled_ = loop_state.at(from + 2) != 0;
    const double fall = loop_state.at(from + 3);
    fall_ = fall == 1 ? Fall::falls : fall == 2 ? Fall::landed : Fall::none;
    const double node = loop_state.at(from + 4);
    const bool there = node >= 0 && node < static_cast<double>(displacement_.size());
    fastest_ = {there ? static_cast<int>(node) : 0, loop_state.at(from + 5)};
    watch_.take(loop_state, from + 6);
  }

private:
  const Model& model_;
  const State& state_;
  StabilityWatch watch_;
  std::vector<Node> displacement_;                        // m, at the last look (n_nodes)
  enum class Fall : std::uint8_t { none, falls, landed }; // of loose pieces; what bounces has landed
  bool has_settled_ = false;
  Fall fall_ = Fall::none;
  double path_ = 0;         // m, of the fastest node
  double work_on_rest_ = 0; // J, of the loads on the pieces that were in balance
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

class Relaxation final : public Procedure {
public:
  Relaxation(const StageContext& context, const RelaxOptions& options, const std::string& kind)
      : model_(context.model), options_(options), state_(context.state), last_good_(context.last_good),
        stage_(context, kind, model_.length), masses_(model_, stage_.work.resolved.bolts),
        previous_force_(masses_.of_nodes().size()), settled_(options.residual),
        period_(context.from ? context.from->loop_state.at(0) : slowest_period(model_, masses_.of_nodes())),
        rounding2_(context.from ? context.from->loop_state.at(1)
                                : rounding_forces2(masses_.of_nodes(), model_.length)),
        stability_(model_, state_, period_) {
    ResolvedConditions& resolved = stage_.work.resolved;
    stage_.work.contact.damps = false; // its steps are no times
    stage_.in_real_time = false;
    stage_.breaking = options.breaking;
    update_external(resolved, state_.time);
    stage_.carried = {&previous_force_};
    const double way = longest_way(model_, state_, resolved);
    if (context.from ? context.from->carried.size() > 1 : way > 0) {
      way_ = SupportWay(masses_.of_nodes().size(), period_, way, options.residual);
      contact_force_.resize(masses_.of_nodes().size());
      stage_.carried.insert(stage_.carried.end(), {&way_.lead(), &contact_force_});
    }
    if (context.from)
      for (std::size_t i = 0; i < stage_.carried.size() && i < context.from->carried.size(); ++i)
        *stage_.carried[i] = context.from->carried[i];
    else
      begin_at_rest();
    stop_supports(resolved);
    Progress& goals = stage_.report.goals;
    goals.note = options.note;
    goals.trial = !options.note.empty();
    goals.residual_goal = options.residual;
    goals.max_steps = options.max_steps;
    forces_known_ = stage_.step > 0;
    largest_reaction2_ = initial_stress_forces2(resolved);
    if (context.from)
      take(context.from->loop_state);
    kept_kinetic_ = stage_.report.sums.kinetic;
    stage_.looks = options.looks;
    if (options.callback && options.callback_every > 0)
      stage_.looks.insert(stage_.looks.begin(), {options.callback_every, 0, options.callback});
  }

  RelaxResult solve() {
    find_balance();
    RelaxResult result;
    static_cast<StageResult&>(result) = stage_.finish();
    result.converged = converged_;
    result.verdict = converged_ ? Verdict::stable : failing_ ? Verdict::failing : Verdict::undecided;
    result.broken_while_drawn = broken_while_drawn_;
    result.way_done = way_.done();
    stability_.describe(result);
    return result;
  }

  bool is_over() const override {
    return stage_.step >= options_.max_steps || converged_ || (failing_ && options_.stop_on_failure);
  }
  double time_step() const override { return 1; }

  void begin_step(bool changed, bool /*joined*/) override {
    if (changed) {
      masses_ = FictitiousMasses(model_, stage_.work.resolved.bolts);
      previous_force_.assign(masses_.of_nodes().size(), {});
      forces_known_ = false;
      slow_.forget();
      stability_.renumbered();
    }
    if (changed || way_.acts()) {
      stop_supports(stage_.work.resolved);
      if (const double left = way_.left(); left != 0)
        aim_supports(model_, state_, stage_.work.resolved, left);
    }
    stage_.breaking = options_.breaking;
  }

  std::vector<double> loop_state() override {
    kept_kinetic_ = stage_.report.sums.kinetic;
    std::vector<double> numbers{period_,
                                rounding2_,
                                lambda_,
                                damping_,
                                largest_reaction2_,
                                largest_led_reaction2_,
                                kept_kinetic_,
                                forces_known_ ? 1.0 : 0.0,
                                slow_.frequency2().value_or(-1),
                                has_settled_ ? 1.0 : 0.0,
                                static_cast<double>(broken_while_drawn_)};
    settled_.add_to(numbers);
    masses_.add_to(numbers);
    way_.add_to(numbers);
    stability_.add_to(numbers);
    return numbers;
  }

  void take_contacts(double /*longest_step*/) override {
    masses_.follow(model_, stage_.work.contact.loads);
    if (!way_.acts() || !way_.see_contacts(change_of_contacts2()))
      return;
    aim_supports(model_, state_, stage_.work.resolved, way_.left());
    stage_.breaking = false;
  }
  void update_loads() override { stage_.update_loads(nullptr); }

  void move(Range range, const Node* force, NodeSums& sums) override {
    const auto nodes = [&](Range part) {
      return moving_nodes(state_, stage_.work.acting(), masses_.of_nodes(), part,
                          force + (part.begin - range.begin));
    };
    each_node(
        stage_.work.resolved, range,
        [&](Range part) {
          led(nodes(part), part.begin, {1, 1, 1, 0}, {}, sums, [&](const MovingNodes& moving) {
            relax_nodes(moving, damping_, previous_force_.data() + part.begin, sums);
          });
        },
        [&](const HeldNode& h) {
          led(nodes({h.node, h.node + 1}), h.node, h.free, h.prescribed, sums,
              [&](const MovingNodes& moving) {
                relax_held_node(moving, h, damping_, previous_force_[h.node], sums);
              });
        });
  }
  void move_rigid(int rigid, NodeSums& sums) override {
    hold_rigid(model_, state_, stage_.work.acting(), rigid, sums);
  }

  void end_step() override {
    NodeSums& sums = stage_.report.sums;
    largest_reaction2_ = std::max(largest_reaction2_, sums.reaction2);
    sums.reaction2 = std::max({sums.reaction2, reaction_floor2 * largest_reaction2_, rounding2_});
    largest_led_reaction2_ = std::max(largest_led_reaction2_, sums.led_reaction2);
    sums.led_reaction2 = std::max(sums.led_reaction2, reaction_floor2 * largest_led_reaction2_);
    way_.end_step();
  }

  void judge() override {
    const double residual = stage_.report.residual;
    if (judges_ && stage_.is_due(watch_every)) {
      stage_.see_whole();
      stability_.look(stage_.step, residual, loose(), has_settled_, way_.stands());
      failing_ = stability_.watch().failing();
    }
    choose_damping(stage_.report.sums);
    if (stage_.broken_in_step() == 0 && way_.stands())
      settled_.add(residual);
    else
      settled_.start_anew();
    if (stage_.broken_in_step() > 0)
      has_settled_ = false;
    if (way_.drawn())
      broken_while_drawn_ += stage_.broken_in_step();
    way_.choose_pace(residual, damping_, stage_.report.sums);
    if (settled_.reached(0.5 * damping_)) {
      converged_ = loose().nodes.empty();
      has_settled_ = true;
      if (!converged_)
        settled_.start_anew();
    }
  }

private:
  LoosePieces loose() {
    stage_.see_surfaces(previous_force_);
    return loose_pieces(model_, state_, stage_.work, previous_force_, options_.residual);
  }

  // N2, since the step before, squared norm.
  double change_of_contacts2() {
    const std::vector<Node>& force = stage_.work.contact.loads.force;
    if (force.empty())
      return 0;
    ExactSums<1> sum;
    const Range own = stage_.work.part().nodes();
    for (std::int64_t i = own.begin; i < own.end; ++i) {
      Node& before = contact_force_[i];
      const double x = force[i].x - before.x, y = force[i].y - before.y, z = force[i].z - before.z;
      if (const double change2 = x * x + y * y + z * z; change2 != 0)
        sum.add(0, change2);
      before = force[i];
    }
    ranks().sum(sum.data(), ExactSums<1>::size());
    return sum.value(0);
  }

  template <class Relax>
  void led(const MovingNodes& nodes, std::int64_t first, const Node& free, const Node& prescribed,
           NodeSums& sums, const Relax& relax) {
    if (way_.takes_back()) {
      way_.step_back(nodes, first, free, prescribed, previous_force_.data() + first, sums);
      return;
    }
    if (way_.acts())
      way_.take_off(nodes, first);
    relax(nodes);
    if (way_.acts())
      way_.put_on(nodes, first, free, prescribed, previous_force_.data() + first, sums);
  }

  void begin_at_rest() {
    const double moving = energy(model_, state_).total();
    stop(state_);
    std::fill(state_.viscous_stress.begin(), state_.viscous_stress.end(), StressBatch{});
    state_.velocity_lag = 0;
    state_.spent.fictitious += moving - energy(model_, state_).total();
  }

  // However a relaxation ends, it leaves the state at rest: its velocities are lengths per step of fictitious masses.
  void find_balance() {
    const struct AtRest {
      Relaxation& r;
      ~AtRest() {
        r.stage_.synchronise();
        r.state_.spent.fictitious += r.stage_.report.sums.kinetic;
        stop(r.state_);
        stop(r.last_good_);
        rest_contacts(r.model_, r.state_);
      }
    } at_rest{*this};
    try {
      stage_.make_steps(*this);
    } catch (const SolutionError&) {
      if (!options_.stop_on_failure || !stability_.watch().suspicious())
        throw;
      // It ran too far between two looks: what is kept is the last one.
      stage_.go_back();
      stage_.report.sums.kinetic = kept_kinetic_;
      failing_ = true;
    }
  }

  void choose_damping(const NodeSums& sums) {
    if (sums.inertia > 0 && (forces_known_ || stage_.step <= 1)) {
      const double quotient = std::max(0.0, sums.stiffness / sums.inertia);
      lambda_ += (stage_.step < 3 ? 1.0 : smoothing) * (quotient - lambda_);
    }
    forces_known_ = true;
    if (way_.stands() && stage_.is_due(slow_mode_every)) {
      stage_.see_surfaces(previous_force_);
      slow_.look(state_, previous_force_, masses_.of_nodes());
    }
    damping_ = std::min(std::max(2 * std::sqrt(std::min(lambda_, slow_.frequency2().value_or(lambda_))),
                                 way_.least_damping()),
                        most_damping);
  }

  void take(const std::vector<double>& numbers) {
    lambda_ = numbers.at(2);
    damping_ = numbers.at(3);
    largest_reaction2_ = numbers.at(4);
    largest_led_reaction2_ = numbers.at(5);
    stage_.report.sums.kinetic = numbers.at(6);
    forces_known_ = numbers.at(7) != 0;
    slow_.take(numbers.at(8));
    has_settled_ = numbers.at(9) != 0;
    broken_while_drawn_ = static_cast<std::int64_t>(numbers.at(10));
    const std::size_t after_way = way_.take(numbers, masses_.take(numbers, settled_.take(numbers, 11)));
    if (forces_known_ && way_.stands())
      slow_.start(state_, previous_force_);
    stability_.take(numbers, after_way);
  }

  const Model& model_;
  const RelaxOptions& options_;
  State &state_, &last_good_;
  Stage stage_;
  FictitiousMasses masses_;
  std::vector<Node> previous_force_; // N, of the step before
  Settled settled_;
  SlowMode slow_;
  SupportWay way_;
  std::vector<Node> contact_force_; // N, of the step before; empty: no support is moved
  const double period_;             // steps, the slowest; of the model that the relaxation began with
  const double rounding2_;          // N2
  Stability stability_;
  // Without supports nothing could hold the model: a mistake, that ends with an error.
  const bool judges_ = !stage_.work.resolved.held.empty();
  bool failing_ = false, converged_ = false;
  std::int64_t broken_while_drawn_ = 0; // bonds
  bool has_settled_ = false;            // as a whole, though a piece may not be in balance
  bool forces_known_ = false;           // of the step before
  double lambda_ = 0, damping_ = 0;
  double largest_reaction2_ = 0, largest_led_reaction2_ = 0; // N2, of the stage
  double kept_kinetic_ = 0;                                  // J, of the state that was kept last
};

} // namespace

RelaxResult relax(const StageContext& context, const RelaxOptions& options, const std::string& kind) {
  require_no_quiet(context.conditions);
  require_given_pressures(context.conditions);
  require_held(context.model, resolve(context.model, context.state, context.conditions));
  return Relaxation(context, options, kind).solve();
}

} // namespace cdem
