#include "libcdem/procedure/critical_flow.hpp"

#include "libcdem/checkpoint/archive.hpp"
#include "libcdem/load/flow.hpp"
#include "libcdem/procedure/flow_measures.hpp"
#include "libcdem/procedure/held_pressure.hpp"
#include "libcdem/procedure/relax.hpp"
#include "libcdem/procedure/run.hpp"
#include "libcdem/ranks/state_shares.hpp"
#include "libcdem/results/fragments.hpp"
#include "libcdem/step/errors.hpp"
#include "libgeom/core/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem {

CDEM_ARCHIVE(HeldPressure, base_time, base, rate, limit, resume)
CDEM_ARCHIVE(CriticalFlowSample, time, pressure, velocity, displacement, broken)

namespace {

constexpr double first_velocity = 1;        // m/s, of the unbroken reference: far below any strength
constexpr double reference_residual = 1e-5; // of its relaxation
constexpr std::int64_t steps_per_look = 20; // at new breaks
constexpr std::int64_t looks_per_judgement = 5;

// The loops of the stage, one after the other.
enum class SearchPart : std::uint8_t { other_loads, reference, search };

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

double volume_of(const Model& model) {
  double volume = 0;
  for (const Block& block : model.blocks)
    volume += block.mass.volume;
  return volume;
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

// What the search keeps around the loops of its parts.
struct SearchState {
  SearchPart part = SearchPart::other_loads;
  NodeForces pattern;               // N at 1 Pa, where the faces were when the stage began
  std::vector<Node> start;          // m, displacement before the flow (n_nodes)
  double start_time = 0;            // s, when the pressure begins to rise
  std::size_t first_break = 0;      // in the log
  std::int64_t seen = 0, looks = 0; // breaks, and looks at them
  HeldPressure pressure;
  CriticalFlowResult result;
};

template <class A>
void archive(A& a, SearchState& x) {
  auto& [part, pattern, start, start_time, first_break, seen, looks, pressure, result] = x;
  archive_all(a, part, pattern, start, start_time, first_break, seen, looks, pressure, result.compliance,
              result.period, result.first_break_pressure, result.first_break_velocity,
              result.first_break_place, result.curve);
}

class Search {
public:
  Search(const StageContext& context, const CriticalFlowOptions& options)
      : model_(context.model), state_(context.state), options_(options), without_flow_(context),
        conditions_(context.conditions), volume_(volume_of(context.model)) {
    const double density = options.flow.water_density;
    now_.pressure = {0, flow_pressure(first_velocity, density), options.pressure_rate,
                     flow_pressure(options.max_velocity, density)};
    Flow flow = options.flow;
    flow.relative = false; // the paper's: the solid is held
    flow.velocity = [this, density](double time) {
      return now_.part == SearchPart::search ? flow_velocity(now_.pressure.at(time), density)
                                             : first_velocity;
    };
    conditions_.flows.push_back(flow);
    resolved_ = resolve(model_, state_, conditions_);
    without_flow_.renumbered = [this](const std::vector<int>& old_node) { renumber(old_node); };
    without_flow_.procedure_state = [this] {
      Writer a;
      archive(a, now_);
      return a.take();
    };
  }
  Search(const Search&) = delete;
  Search& operator=(const Search&) = delete;
  CriticalFlowResult operator()();

private:
  std::int64_t broken() const {
    return static_cast<std::int64_t>(without_flow_.log.breaks.size() - now_.first_break);
  }
  void start();
  void renumber(const std::vector<int>& old_node);
  void begin(SearchPart);
  StageContext with_flow() const {
    const StageContext& c = without_flow_;
    return {c.model,    c.state,           conditions_,  c.log,         c.last_good,
            c.observer, c.threads,         c.number,     c.checkpoints, c.restart_point,
            c.from,     c.procedure_state, c.renumbered, c.seen,        c.changing};
  }
  void measure();
  void look();
  CriticalFlowResult raise();

  const Model& model_;
  State& state_;
  const CriticalFlowOptions& options_;
  StageContext without_flow_;
  Conditions conditions_; // with the flow
  ResolvedConditions resolved_;
  double volume_; // m3
  bool ended_ = false;
  SearchState now_;
};

// Copies of a node share its force by their mass.
void Search::renumber(const std::vector<int>& old_node) {
  std::vector<double> mass(now_.start.size(), 0.0);
  std::vector<geom::Vec3> force(now_.start.size(), geom::Vec3::Zero());
  for (const auto& [node, f] : now_.pattern)
    force[node] += f;
  const std::vector<Node> start = std::move(now_.start);
  now_.start.clear();
  for (std::size_t i = 0; i < old_node.size(); ++i) {
    now_.start.push_back(start[old_node[i]]);
    mass[old_node[i]] += model_.node_mass[i];
  }
  now_.pattern.clear();
  for (std::size_t i = 0; i < old_node.size(); ++i)
    if (!force[old_node[i]].isZero(0))
      now_.pattern.emplace_back(static_cast<int>(i),
                                model_.node_mass[i] / mass[old_node[i]] * force[old_node[i]]);
}

void Search::start() {
  require_held(resolved_);
  if (options_.held)
    require_held_there(model_, resolved_, *options_.held);
  now_.pattern = resolved_.varying[resolved_.flows.back().load].forces;
  if (now_.pattern.empty())
    throw geom::InputError(
        "critical_flow: no outer face of the place looks towards the flow; turn its direction");
  begin(SearchPart::other_loads);
}

void Search::begin(SearchPart part) {
  now_.part = part;
  without_flow_.from = nullptr;
  without_flow_.last_good = state_;
  mark_start_of_loop(without_flow_);
}

// The unbroken solid at rest under the small pressure.
void Search::measure() {
  CriticalFlowResult& result = now_.result;
  const double reference = displacement_along(now_.pattern, state_, now_.start);
  if (!(reference > 0))
    throw geom::InputError(
        "critical_flow: the flow moves nothing: every face it meets is held; hold a side only");
  result.compliance = reference / now_.pressure.base;
  result.period = first_period(model_, now_.pattern, now_.pressure.base, state_, now_.start);
  now_.start_time = now_.pressure.base_time = state_.time;
  now_.first_break = without_flow_.log.breaks.size();
}

void Search::look() {
  CriticalFlowResult& result = now_.result;
  const RunLog& log = without_flow_.log;
  const double density = options_.flow.water_density;
  if (now_.seen == 0 && broken() > 0) {
    result.first_break_pressure = now_.pressure.at(log.breaks[now_.first_break].time);
    result.first_break_velocity = flow_velocity(result.first_break_pressure, density);
    result.first_break_place = broken_area(log, now_.first_break, true).centroid;
  }
  if (options_.hold && broken() > now_.seen)
    now_.pressure.hold(state_.time, state_.time + options_.hold_periods * result.period);
  else if (now_.pressure.resume >= 0 && state_.time >= now_.pressure.resume)
    now_.pressure.go_on(state_.time);
  now_.seen = broken();
  if (++now_.looks % looks_per_judgement != 0)
    return;
  make_whole(state_);
  const double now = now_.pressure.at(state_.time),
               moved = displacement_along(now_.pattern, state_, now_.start);
  result.curve.push_back({state_.time - now_.start_time, now, flow_velocity(now, density), moved, now_.seen});
  result.fragments = fragments(model_, state_, resolved_);
  const bool loose = std::any_of(result.fragments.begin(), result.fragments.end(), [&](const Fragment& f) {
    return !f.held && f.volume >= options_.fragment_fraction * volume_;
  });
  if (loose)
    result.reason = CriticalFlowResult::Reason::fragment;
  else if (moved >= options_.compliance_ratio * result.compliance * now)
    result.reason = CriticalFlowResult::Reason::compliance;
  ended_ = loose || result.reason == CriticalFlowResult::Reason::compliance || now >= now_.pressure.limit;
}

CriticalFlowResult Search::raise() {
  const double density = options_.flow.water_density;
  RunOptions stepping;
  stepping.steps = std::numeric_limits<std::int64_t>::max();
  stepping.safety = options_.safety;
  stepping.mass_scaling = options_.mass_scaling;
  stepping.local_damping = options_.local_damping;
  stepping.follows_fragments = false; // crumbs may go where they like until it ends
  stepping.callback_every = steps_per_look;
  stepping.callback = [&] { look(); };
  stepping.stop = [&] { return ended_; };
  stepping.details = [&](Progress& progress) {
    progress.note = fmt::format("flow {:.3g} m/s", flow_velocity(now_.pressure.at(state_.time), density));
  };
  const RunResult ran =
      run(with_flow(), stepping, options_.hold ? "critical_flow: hold" : "critical_flow: ramp");

  CriticalFlowResult& result = now_.result;
  result.pressure = now_.pressure.at(state_.time);
  result.velocity = flow_velocity(result.pressure, density);
  result.time = state_.time - now_.start_time;
  result.broken_tension = ran.broken_tension;
  result.broken_shear = ran.broken_shear;
  result.steps = ran.steps;
  result.time_step = ran.time_step;
  result.scaled = ran.scaled;
  const BrokenArea all = broken_area(without_flow_.log, now_.first_break, false);
  result.broken_area = all.area;
  result.place = all.centroid;
  return std::move(result);
}

CriticalFlowResult Search::operator()() {
  if (const RestartPoint* const from = without_flow_.from) {
    Reader a(from->procedure_state);
    archive(a, now_);
    if (from->step == 0) // where a part begins
      without_flow_.from = nullptr;
  } else {
    start();
  }
  if (now_.part == SearchPart::other_loads) {
    if (without_flow_.conditions.load()) // what they do is none of the flow's
      find_balance(without_flow_, "critical_flow: other loads");
    now_.start = state_.displacement;
    begin(SearchPart::reference);
  }
  if (now_.part == SearchPart::reference) {
    find_balance(with_flow(), "critical_flow: reference");
    measure();
    begin(SearchPart::search);
  }
  return raise();
}

} // namespace

CriticalFlowResult critical_flow(const StageContext& context, const CriticalFlowOptions& options) {
  return Search(context, options)();
}

} // namespace cdem
