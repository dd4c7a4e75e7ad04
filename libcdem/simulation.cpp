#include "libcdem/checkpoint/model_archive.hpp"
#include "libcdem/first_model.hpp"
#include "libcdem/procedure/critical_flow.hpp"
#include "libcdem/procedure/grow.hpp"
#include "libcdem/procedure/refine.hpp"
#include "libcdem/procedure/relax.hpp"
#include "libcdem/procedure/run.hpp"
#include "libcdem/procedure/settle.hpp"
#include "libcdem/ranks/ranks.hpp"
#include "libcdem/simulation_checks.hpp"
#include "libcdem/simulation_impl.hpp"

#include <algorithm>

namespace cdem {

namespace {

// Ranks with different models would wait for each other without end.
void require_same_on_all_ranks(std::uint64_t model) {
  if (ranks().alone())
    return;
  const std::vector<std::string> built = ranks().gather(std::to_string(model));
  for (std::size_t rank = 1; rank < built.size(); ++rank)
    if (built[rank] != built[0])
      throw geom::InputError(
          "rank " + std::to_string(rank) +
          " has built another model than rank 0; a script must do the same on all ranks: "
          "look for what it takes from the clock, the order of pairs() or files that change");
}

} // namespace

Simulation::Simulation(const ModelSpec& spec, int threads, std::shared_ptr<Observer> observer)
    : impl_(std::make_unique<Impl>()) {
  if (threads < 1)
    throw geom::InputError("threads", std::to_string(threads), "an integer >= 1");
  impl_->threads = threads;
  impl_->observer = observer ? std::move(observer) : std::make_shared<Observer>();
  impl_->model = first_model(spec);
  impl_->built = hash(impl_->model);
  require_same_on_all_ranks(impl_->built);
  impl_->kept = initial_state(impl_->model);
  impl_->last_good = impl_->whole();
  impl_->log.unmet = pairs_without_interface(spec, impl_->model);
}

Simulation::Simulation(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

Simulation Simulation::copy() const {
  auto other = std::make_unique<Impl>();
  SimulatedModel& s = *other;
  impl_->whole();
  s = *impl_;
  s.stage = 0;
  s.replaying = false;
  s.work = nullptr; // one stage takes it
  s.log = {};
  s.log.unmet = impl_->log.unmet;
  if (!s.end_of_run) {
    s.last_good = s.kept;
  } else {
    s.end_of_run->point.breaks = 0;
    s.end_of_run->point.one_way = {};
  }
  return Simulation(std::move(other));
}

namespace {

// A stage that goes on from a checkpoint finds in its log what it has come to.
void sample_every(const StageContext& context, std::int64_t steps) {
  if (steps > 0 && (!context.from || context.from->step == 0))
    context.log.every = steps;
}

// Cutting knows convex blocks only.
void require_blocks(const Model& model, const char* call) {
  if (!std::all_of(model.blocks.begin(), model.blocks.end(), [](const Block& b) { return b.convex(); }))
    throw geom::InputError(std::string(call) +
                           ": the model has meshed bodies; only a model of convex blocks alone "
                           "can be cut");
}

} // namespace

void Simulation::check_stage() {
  impl_->warnings.before_stage();
}

RelaxResult Simulation::relax(const RelaxOptions& options) {
  check(options);
  impl_->warnings.of_falling_forces();
  RelaxResult result;
  impl_->stages.run([&](const StageContext& context) {
    sample_every(context, options.history_every);
    result = cdem::relax(context, options);
  });
  return result;
}

RunResult Simulation::run(const RunOptions& options) {
  check(options);
  const double begin = time();
  RunResult result;
  impl_->stages.run(
      [&](const StageContext& context) {
        sample_every(context, options.history_every);
        result = cdem::run(context, options);
      },
      SimulatedModel::StepChoice{options.safety, options.time_step, options.mass_scaling.step,
                                 options.mass_scaling.factor});
  impl_->warnings.look_for_dry_flows(begin, time());
  return result;
}

SettleResult Simulation::settle(const SettleOptions& options) {
  check(options);
  SettleResult result;
  impl_->stages.run(
      [&](const StageContext& context) { result = cdem::settle(impl_->model, context, options); });
  return result;
}

CriticalFlowResult Simulation::critical_flow(const CriticalFlowOptions& options) {
  check(options);
  CriticalFlowResult result;
  impl_->stages.run([&](const StageContext& context) { result = cdem::critical_flow(context, options); });
  return result;
}

std::vector<BlockCut> Simulation::refine(const RefineOptions& options) {
  require_blocks(impl_->model, "refine");
  if (options.region) {
    bool holds_blocks = false;
    for (int b = 0; b < static_cast<int>(impl_->model.blocks.size()); ++b)
      holds_blocks = holds_blocks || selects_block(impl_->model, *options.region, b);
    if (!holds_blocks)
      throw geom::InputError("region", options.region->text, "a place that holds block centroids",
                             "nothing of the model lies there");
  }
  Refined refined = cdem::refine(impl_->model, impl_->whole(), options);
  ++impl_->stage;
  impl_->adopt(std::move(refined.rebuilt));
  return std::move(refined.cuts);
}

GrowResult Simulation::grow(const GrowOptions& options) {
  Impl& s = *impl_;
  require_blocks(s.model, "grow");
  GrowResult result;
  s.stages.run_whole([&](const StageContext& context) {
    const auto relax = [&](const RelaxOptions& o, const std::string& kind) {
      RelaxResult relaxed = cdem::relax(context, o, kind);
      s.last_residual = relaxed.residual;
      return relaxed;
    };
    result = cdem::grow({s.model, s.changing(), s.log, *s.observer, context.number, relax,
                         [&](Rebuilt&& r) { s.adopt(std::move(r)); }},
                        options);
  });
  return result;
}

std::string Simulation::save() const {
  return impl_->stages.save();
}
void Simulation::gather_to_save() {
  impl_->stages.gather_to_save();
}
void Simulation::restore(const std::string& saved) {
  impl_->stages.restore(saved, false);
}
void Simulation::restore_state(const std::string& saved) {
  impl_->stages.restore(saved, true);
}
void Simulation::set_checkpoint_writer(CheckpointWriter* checkpoints) {
  impl_->stages.set_writer(checkpoints);
}
void Simulation::set_replaying(bool replaying) {
  impl_->replaying = replaying;
}

} // namespace cdem
