#include "libcdem/procedure/settle.hpp"

#include "libcdem/checkpoint/archive.hpp"
#include "libcdem/model/names.hpp"
#include "libcdem/procedure/run.hpp"
#include "libcdem/procedure/turn_rigid.hpp"
#include "libcdem/ranks/state_shares.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/core/portable.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace cdem {

CDEM_ARCHIVE(SettlePhase, name, steps, time, kinetic_ratio, residual)
CDEM_ARCHIVE(SettleResult, converged, kinetic_ratio, peak_kinetic, steps, time, made_rigid, phases, fastest,
             fastest_speed, wall_time)

namespace {

// Steps between looks at the kinetic energy, and how many in a row must find it low: a body at the top of a bounce
// stands still for a moment.
constexpr std::int64_t settle_look = 20;
constexpr int quiet_looks = 25;
// Units that deform again have taken up their weight when the forces out of balance are this part of the loads; slow
// motion alone does not tell: what a stiff unit moves by is little from the start.
constexpr double balanced = 0.01;

// The loops of the stage, of which it goes through one or two.
enum class SettlePart : std::uint8_t { rigid, free, last };

// Looks at the kinetic energy of a stage.
struct Calm {
  double peak = 0, ratio = 0; // J; kinetic energy over its peak
  int quiet = 0;              // looks in a row that found it low
  void look(double kinetic, double goal) {
    peak = std::max(peak, kinetic);
    ratio = peak > 0 ? kinetic / peak : 0;
    quiet = ratio <= goal ? quiet + 1 : 0;
  }
};

// Deformable meshed blocks of which nothing is held, or all of it at a velocity: they can fall as rigid bodies.
std::vector<int> can_be_rigid(const Model& model, const ResolvedConditions& r) {
  std::vector<int> held(model.blocks.size(), 0), whole(model.blocks.size(), 0);
  for (const HeldNode& h : r.held) {
    const int block = block_of(model, h.node);
    ++held[block];
    const bool all = h.free.x == 0 && h.free.y == 0 && h.free.z == 0 && h.prescribed.x == 0 &&
                     h.prescribed.y == 0 && h.prescribed.z == 0 && std::isnan(h.target.x) &&
                     std::isnan(h.target.y) && std::isnan(h.target.z);
    whole[block] += all ? 1 : 0;
  }
  std::vector<int> blocks;
  for (int b = 0; b < static_cast<int>(model.blocks.size()); ++b) {
    const Block& block = model.blocks[b];
    if (block.meshed && block.rigid < 0 && (held[b] == 0 || whole[b] == block.node_end - block.node_begin))
      blocks.push_back(b);
  }
  return blocks;
}

// Velocities count as those of the present from here on, which at rest they are: what deforms again takes other steps.
void take_velocities_as_present(const Model& model, State& state) {
  const double before = energy(model, state).total();
  state.velocity_lag = 0;
  state.spent.fictitious += before - energy(model, state).total();
}

// What settling keeps around the loops of its phases.
struct SettleState {
  SettlePart part = SettlePart::rigid;
  double start = 0, part_start = 0; // s
  std::int64_t looks = 0;           // in this part
  std::vector<int> turned;          // blocks that are rigid while they fall
  Calm calm;
  SettleResult result;
};

CDEM_ARCHIVE(Calm, peak, ratio, quiet)
CDEM_ARCHIVE(SettleState, part, start, part_start, looks, turned, calm, result)

class Settling {
public:
  Settling(Model& model, const StageContext& context, const SettleOptions& options)
      : model_(model), state_(context.state), options_(options), context_(context) {
    context_.procedure_state = [this] {
      Writer a;
      archive(a, now_);
      return a.take();
    };
  }
  SettleResult operator()();

private:
  // Ends at rest, or at the first contact.
  enum class Until { rest, touch };

  bool deforms() const {
    return std::any_of(model_.blocks.begin(), model_.blocks.end(),
                       [](const Block& block) { return block.rigid < 0; });
  }
  void start();
  void begin(SettlePart);
  void phase(const std::string& name, double time_step, Until);

  Model& model_;
  State& state_;
  const SettleOptions& options_;
  StageContext context_;
  SettleState now_;
};

void Settling::start() {
  now_.start = state_.time;
  if (options_.rigid)
    now_.turned = can_be_rigid(model_, resolve(model_, state_, context_.conditions));
  context_.observer.message(fmt::format(
      "stage {} settle: for the deposition alone {}local damping {:g} of what touches{}; off "
      "afterwards",
      context_.number,
      now_.turned.empty()       ? ""
      : now_.turned.size() == 1 ? "1 unit is rigid, with "
                                : fmt::format("{} units are rigid, with ", now_.turned.size()),
      options_.local_damping,
      options_.friction_angle
          ? fmt::format(" and friction of at most {:g} degrees", *options_.friction_angle * 180 / M_PI)
          : ""));
  now_.result.made_rigid = static_cast<std::int64_t>(now_.turned.size());
  if (!now_.turned.empty()) {
    set_rigid(model_, state_, now_.turned);
    begin(SettlePart::rigid);
  } else {
    begin(deforms() && state_.contacts.empty() ? SettlePart::free : SettlePart::last);
  }
}

void Settling::begin(SettlePart part) {
  now_.part = part;
  now_.part_start = state_.time;
  now_.looks = 0;
  now_.calm.quiet = 0;
  context_.from = nullptr;
  context_.last_good = state_;
  mark_start_of_loop(context_);
}

void Settling::phase(const std::string& name, double time_step, Until until) {
  RunOptions stepping;
  stepping.duration = now_.start + options_.max_time - state_.time;
  if (!(stepping.duration > 0))
    return;
  stepping.safety = options_.safety;
  stepping.time_step = time_step;
  stepping.local_damping = until == Until::touch ? 0 : options_.local_damping;
  stepping.damp_flight = false;
  stepping.holds_what_left = true; // else nothing would come to rest
  if (options_.friction_angle)
    stepping.most_friction = geom::portable::tan(*options_.friction_angle);
  const std::int64_t looks_per_call =
      options_.callback ? (options_.callback_every + settle_look - 1) / settle_look : 0;
  stepping.callback_every = settle_look;
  stepping.callback = [&] {
    make_whole(state_);
    now_.calm.look(kinetic_energy(model_, state_), options_.kinetic_energy_ratio);
    ++now_.looks;
    if (looks_per_call > 0 && now_.looks % looks_per_call == 0)
      options_.callback();
  };
  stepping.looks = options_.looks;
  stepping.stop = [&] {
    make_whole(state_);
    return until == Until::touch ? !state_.contacts.empty() : now_.calm.quiet >= quiet_looks;
  };
  const bool takes_up_loads = now_.part == SettlePart::last && deforms() && context_.conditions.load();
  if (takes_up_loads)
    stepping.stop_residual = balanced;
  stepping.details = [&](Progress& progress) {
    if (until == Until::touch)
      return;
    progress.kinetic_ratio = now_.calm.ratio;
    progress.kinetic_ratio_goal = options_.kinetic_energy_ratio;
    if (takes_up_loads)
      progress.residual_goal = balanced;
  };
  const RunResult ran = run(context_, stepping, "settle: " + name);
  SettleResult& result = now_.result;
  const double took = state_.time - now_.part_start;
  result.steps += ran.steps;
  result.wall_time += ran.wall_time;
  result.phases.push_back({name, ran.steps, took, now_.calm.ratio, ran.residual});
  result.converged = now_.calm.quiet >= quiet_looks && ran.residual <= stepping.stop_residual;
  context_.observer.message(
      fmt::format("stage {} settle, {}: {:.4g} s in {} steps of {:.3g} s, kinetic energy {:.3g} of its peak, "
                  "{:.3g} of the loads out of balance",
                  context_.number, name, took, ran.steps, ran.time_step, now_.calm.ratio, ran.residual));
}

SettleResult Settling::operator()() {
  if (const RestartPoint* const from = context_.from) {
    Reader a(from->procedure_state);
    archive(a, now_);
    if (from->step == 0) // where a phase begins
      context_.from = nullptr;
  } else {
    start();
  }
  if (now_.part == SettlePart::rigid) {
    phase("rigid fall", options_.time_step, Until::rest);
    set_deformable(model_, state_, now_.turned);
    take_velocities_as_present(model_, state_);
    begin(SettlePart::last);
  }
  if (now_.part == SettlePart::free) {
    phase("free fall", 0, Until::touch);
    begin(SettlePart::last);
  }
  const bool soft = deforms();
  phase(soft ? "deformable" : "rigid fall", soft ? 0 : options_.time_step, Until::rest);

  SettleResult& result = now_.result;
  result.time = state_.time - now_.start;
  result.kinetic_ratio = now_.calm.ratio;
  result.peak_kinetic = now_.calm.peak;
  if (!result.converged) {
    const std::vector<double> speeds = speeds_of_blocks(model_, state_);
    const auto fastest = std::max_element(speeds.begin(), speeds.end());
    result.fastest = block_name(model_, static_cast<int>(fastest - speeds.begin()));
    result.fastest_speed = *fastest;
  }
  return std::move(result);
}

} // namespace

SettleResult settle(Model& model, const StageContext& context, const SettleOptions& options) {
  return Settling(model, context, options)();
}

} // namespace cdem
