#include "libcdem/step/settle.hpp"

#include "libcdem/results/energy.hpp"
#include "libcdem/rigid/convert.hpp"
#include "libcdem/step/run.hpp"

#include <cmath>
#include <fmt/format.h>

namespace cdem {
namespace {

// Steps between looks at the kinetic energy, and how many in a row must find it low: a body at the top of a bounce
// stands still for a moment.
constexpr std::int64_t steps_per_look = 20;
constexpr int quiet_looks = 25;

// Looks at the kinetic energy of a stage.
class Calm {
public:
  explicit Calm(double ratio) : goal_(ratio) {}
  void begin() { quiet_ = 0; }
  void look(double kinetic) {
    peak_ = std::max(peak_, kinetic);
    ratio_ = peak_ > 0 ? kinetic / peak_ : 0;
    quiet_ = ratio_ <= goal_ ? quiet_ + 1 : 0;
  }
  bool reached() const { return quiet_ >= quiet_looks; }
  double ratio() const { return ratio_; }
  double peak() const { return peak_; }

private:
  double goal_, peak_ = 0, ratio_ = 0;
  int quiet_ = 0;
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

} // namespace

SettleResult settle(Model& model, const StageContext& context, const SettleOptions& options) {
  State& state = context.state;
  const double start = state.time;
  SettleResult result;
  Calm calm(options.kinetic_energy_ratio);

  // Ends at rest, or where something touches first.
  enum class Until { rest, touch };
  const auto phase = [&](const std::string& name, double time_step, Until until) {
    const double begin = state.time;
    calm.begin();
    RunOptions stepping;
    stepping.duration = start + options.max_time - state.time;
    if (!(stepping.duration > 0))
      return;
    stepping.safety = options.safety;
    stepping.time_step = time_step;
    stepping.local_damping = until == Until::touch ? 0 : options.local_damping;
    stepping.damp_flight = false;
    const std::int64_t looks_per_call =
        options.callback ? (options.callback_every + steps_per_look - 1) / steps_per_look : 0;
    std::int64_t looks = 0;
    stepping.callback_every = steps_per_look;
    stepping.callback = [&] {
      calm.look(kinetic_energy(model, state));
      if (looks_per_call > 0 && ++looks % looks_per_call == 0)
        options.callback();
    };
    stepping.stop = [&] { return until == Until::touch ? !state.contacts.empty() : calm.reached(); };
    const RunResult ran = run(context, stepping, "settle: " + name);
    result.steps += ran.steps;
    result.wall_time += ran.wall_time;
    result.phases.push_back({name, ran.steps, state.time - begin, calm.ratio()});
    context.observer.message(fmt::format(
        "stage {} settle, {}: {:.4g} s in {} steps of {:.3g} s, kinetic energy {:.3g} of its peak",
        context.number, name, state.time - begin, ran.steps, ran.time_step, calm.ratio()));
  };

  std::vector<int> turned;
  if (options.rigid)
    turned = can_be_rigid(model, resolve(model, state, context.conditions));
  context.observer.message(fmt::format(
      "stage {} settle: for the deposition alone {}local damping {:g} of what touches; off "
      "afterwards",
      context.number, turned.empty() ? "" : fmt::format("{} units are rigid, with ", turned.size()),
      options.local_damping));
  result.made_rigid = static_cast<std::int64_t>(turned.size());
  if (!turned.empty()) {
    set_rigid(model, state, turned);
    context.last_good = state;
    phase("rigid fall", options.time_step, Until::rest);
    set_deformable(model, state, turned);
    take_velocities_as_present(model, state);
    context.last_good = state;
  }
  const bool deforms = std::any_of(model.blocks.begin(), model.blocks.end(),
                                   [](const Block& block) { return block.rigid < 0; });
  if (deforms && turned.empty() && state.contacts.empty())
    phase("free fall", 0, Until::touch);
  phase(deforms ? "deformable" : "rigid fall", deforms ? 0 : options.time_step, Until::rest);

  result.time = state.time - start;
  result.converged = calm.reached();
  result.kinetic_ratio = calm.ratio();
  result.peak_kinetic = calm.peak();
  return result;
}

} // namespace cdem
