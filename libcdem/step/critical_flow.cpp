#include "libcdem/step/critical_flow.hpp"

#include "libcdem/load/flow.hpp"
#include "libcdem/results/fragments.hpp"
#include "libcdem/step/errors.hpp"
#include "libcdem/step/relax.hpp"
#include "libcdem/step/run.hpp"
#include "libgeom/core/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

constexpr double first_velocity = 1;        // m/s, of the unbroken reference: far below any strength
constexpr double reference_residual = 1e-5; // of its relaxation
constexpr std::int64_t steps_per_look = 20; // at new breaks
constexpr std::int64_t looks_per_judgement = 5;

geom::Vec3 vec(const Node& n) {
  return {n.x, n.y, n.z};
}

// Displacement that the flow does its work on, over the sum of its weights, m.
double displacement_along(const std::vector<std::pair<int, geom::Vec3>>& pattern, const State& state,
                          const std::vector<Node>& start) {
  double work = 0, weight = 0;
  for (const auto& [node, force] : pattern) {
    work += force.dot(vec(state.displacement[node]) - vec(start[node]));
    weight += force.norm();
  }
  return work / weight;
}

// Rayleigh's quotient of the static shape under the pattern times `pressure`.
double first_period(const Model& model, const std::vector<std::pair<int, geom::Vec3>>& pattern,
                    double pressure, const State& state, const std::vector<Node>& start) {
  double work = 0, inertia = 0;
  for (const auto& [node, force] : pattern)
    work += pressure * force.dot(vec(state.displacement[node]) - vec(start[node]));
  for (std::size_t i = 0; i < start.size(); ++i)
    inertia += model.node_mass[i] * (vec(state.displacement[i]) - vec(start[i])).squaredNorm();
  constexpr double two_pi = 6.283185307179586;
  return two_pi * std::sqrt(inertia / work);
}

// The pressure over time. It rises at a rate from a base point on; a hold keeps it until `resume`.
struct Pressure {
  double base_time, base, rate, limit;
  double resume = -1; // s; > base_time: held until then

  double at(double time) const {
    return resume >= 0 ? base : std::min(limit, base + rate * (time - base_time));
  }
  void hold(double time, double until) {
    base = at(time);
    base_time = time;
    resume = until;
  }
  void go_on(double time) {
    base_time = time;
    resume = -1;
  }
};

void require_held(const ResolvedConditions& r) {
  if (r.held.empty())
    throw geom::InputError(
        "critical_flow: nothing is held, the flow would carry the model away; hold a side with fix");
}

// The state from which everything is measured. Without it the search would compare with noise.
void find_balance(const StageContext& context, const std::string& kind) {
  RelaxOptions rest;
  rest.residual = reference_residual;
  rest.breaking = false;
  const RelaxResult result = relax(context, rest, kind);
  if (!result.converged)
    throw SolutionError(
        fmt::format("stage {} ({}): no balance after {} steps, residual {:.3g} above {:g}; is a part "
                    "of the model loose, or broken before?",
                    context.number, kind, result.steps, result.residual, reference_residual));
}

bool loaded(const Conditions& c) {
  return !c.tractions.empty() || !c.forces.empty() || c.gravity || !c.flows.empty();
}

double volume_of(const Model& model) {
  double volume = 0;
  for (const Block& block : model.blocks)
    volume += block.mass.volume;
  return volume;
}

struct BrokenArea {
  double area = 0;                          // m2
  geom::Vec3 centroid = geom::Vec3::Zero(); // m, undeformed
};

// Of the bonds that broke from `first` on, those of one step only where `step` says so.
BrokenArea broken_area(const RunLog& log, std::size_t first, bool of_one_step) {
  BrokenArea sum;
  for (std::size_t i = first; i < log.breaks.size(); ++i) {
    if (of_one_step && log.breaks[i].step != log.breaks[first].step)
      break;
    sum.area += log.breaks[i].area;
    sum.centroid += log.breaks[i].area * log.breaks[i].place;
  }
  if (sum.area > 0)
    sum.centroid /= sum.area;
  return sum;
}

void require_held_there(const Model& model, const ResolvedConditions& r, const Selection& on) {
  const std::vector<int> there = selected_nodes(model, on);
  const auto is_there = [&](const HeldNode& h) {
    return std::binary_search(there.begin(), there.end(), h.node);
  };
  // A neighbouring side that is held has its edge here.
  if (2 * std::count_if(r.held.begin(), r.held.end(), is_there) < static_cast<std::ptrdiff_t>(there.size()))
    throw geom::InputError("held", on.text, "a side that fix holds", "it is free");
}

} // namespace

CriticalFlowResult critical_flow(const StageContext& context, const CriticalFlowOptions& options) {
  const Model& model = context.model;
  State& state = context.state;
  Conditions conditions = context.conditions;
  const double density = options.flow.water_density;
  const double limit = flow_pressure(options.max_velocity, density);
  Pressure pressure{0, flow_pressure(first_velocity, density), options.pressure_rate, limit};
  Flow flow = options.flow;
  bool moving = false;
  flow.velocity = [&](double time) {
    return moving ? flow_velocity(pressure.at(time), density) : first_velocity;
  };
  conditions.flows.push_back(flow);
  const StageContext with_flow{
      model,           state,          conditions,    context.log, context.last_good, context.observer,
      context.threads, context.number, context.keeper};
  const ResolvedConditions resolved = resolve(model, state, conditions);
  require_held(resolved);
  if (options.held)
    require_held_there(model, resolved, *options.held);
  const auto pattern = resolved.varying[resolved.flows.back().load].forces;
  if (pattern.empty())
    throw geom::InputError(
        "critical_flow: no outer face of the place looks towards the flow; turn its direction");

  if (loaded(context.conditions)) // what they do is none of the flow's
    find_balance(context, "critical_flow: other loads");
  const std::vector<Node> start = state.displacement;
  find_balance(with_flow, "critical_flow: reference");

  CriticalFlowResult result;
  const double reference = displacement_along(pattern, state, start);
  if (!(reference > 0))
    throw geom::InputError(
        "critical_flow: the flow moves nothing: every face it meets is held; hold a side only");
  result.compliance = reference / pressure.base;
  result.period = first_period(model, pattern, pressure.base, state, start);
  const double hold_time = options.hold_periods * result.period, volume = volume_of(model);
  const double start_time = state.time;
  const std::size_t first_break = context.log.breaks.size();
  const auto broken = [&] { return static_cast<std::int64_t>(context.log.breaks.size() - first_break); };
  pressure.base_time = start_time;
  moving = true;

  std::int64_t seen = 0, looks = 0;
  bool ended = false;
  const auto look = [&] {
    if (seen == 0 && broken() > 0) {
      result.first_break_pressure = pressure.at(context.log.breaks[first_break].time);
      result.first_break_velocity = flow_velocity(result.first_break_pressure, density);
      result.first_break_place = broken_area(context.log, first_break, true).centroid;
    }
    if (options.hold && broken() > seen)
      pressure.hold(state.time, state.time + hold_time);
    else if (pressure.resume >= 0 && state.time >= pressure.resume)
      pressure.go_on(state.time);
    seen = broken();
    if (++looks % looks_per_judgement != 0)
      return;
    const double now = pressure.at(state.time), moved = displacement_along(pattern, state, start);
    result.curve.push_back({state.time - start_time, now, flow_velocity(now, density), moved, seen});
    result.fragments = fragments(model, state, resolved);
    const bool loose = std::any_of(result.fragments.begin(), result.fragments.end(), [&](const Fragment& f) {
      return !f.held && f.volume >= options.fragment_fraction * volume;
    });
    if (loose)
      result.reason = CriticalFlowResult::Reason::fragment;
    else if (moved >= options.compliance_ratio * result.compliance * now)
      result.reason = CriticalFlowResult::Reason::compliance;
    ended = loose || result.reason == CriticalFlowResult::Reason::compliance || now >= limit;
  };
  RunOptions stepping;
  stepping.steps = std::numeric_limits<std::int64_t>::max();
  stepping.safety = options.safety;
  stepping.local_damping = options.local_damping;
  stepping.follows_pieces = false; // crumbs may go where they like until it ends
  stepping.callback_every = steps_per_look;
  stepping.callback = look;
  stepping.stop = [&] { return ended; };
  stepping.note = [&] {
    return fmt::format("flow {:.3g} m/s", flow_velocity(pressure.at(state.time), density));
  };
  const RunResult run_result =
      run(with_flow, stepping, options.hold ? "critical_flow: hold" : "critical_flow: ramp");

  result.pressure = pressure.at(state.time);
  result.velocity = flow_velocity(result.pressure, density);
  result.time = state.time - start_time;
  result.broken_tension = run_result.broken_tension;
  result.broken_shear = run_result.broken_shear;
  result.steps = run_result.steps;
  const BrokenArea all = broken_area(context.log, first_break, false);
  result.broken_area = all.area;
  result.place = all.centroid;
  return result;
}

} // namespace cdem
