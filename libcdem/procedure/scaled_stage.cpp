#include "libcdem/procedure/scaled_stage.hpp"

#include "libcdem/contact/response/contact_bounds.hpp"
#include "libcdem/integrate/mass_scaling.hpp"
#include "libcdem/integrate/row_sums.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/core/error.hpp"

namespace cdem {

ScaledStage::ScaledStage(const StageContext& context, double step, double safety)
    : context_(context), step_(step), safety_(safety) {
  if (on() && context_.state.moving_mass.empty())
    scale();
}

ScaledStage::~ScaledStage() {
  if (on())
    set({});
}

void ScaledStage::scale() {
  std::vector<double> row_sums = all_row_sums(context_.model);
  const std::vector<double> closing = closing_row_sums(context_.model);
  for (std::size_t i = 0; i < row_sums.size(); ++i)
    row_sums[i] = std::max(row_sums[i], closing[i]);
  set(scaled_masses(context_.model, row_sums, step_ / safety_));
}

void ScaledStage::set(std::vector<double> masses) {
  State& state = context_.state;
  const double before = kinetic_energy(context_.model, state);
  state.moving_mass = std::move(masses);
  state.spent.fictitious += before - kinetic_energy(context_.model, state);
}

void ScaledStage::sample() {
  const EnergyLedger now = energy(context_.model, context_.state);
  kinetic_ += now.kinetic;
  stored_ += now.elastic + now.springs;
}

ScaledMasses ScaledStage::report() const {
  const AddedMass added = added_mass(context_.model, moving_mass(context_.model, context_.state));
  ScaledMasses report;
  report.added_share = added.share;
  if (added.body >= 0)
    report.body = context_.model.bodies[added.body].name;
  report.body_share = added.body_share;
  if (kinetic_ > 0)
    report.kinetic_share = stored_ > 0 ? kinetic_ / stored_ : std::numeric_limits<double>::infinity();
  return report;
}

void ScaledStage::add_to(std::vector<double>& loop_state) const {
  loop_state.insert(loop_state.end(), {kinetic_, stored_, step_});
}

void ScaledStage::take(const std::vector<double>& loop_state) {
  if (!on() || loop_state.size() < 3)
    return;
  kinetic_ = loop_state[loop_state.size() - 3];
  stored_ = loop_state[loop_state.size() - 2];
}

void require_scalable(const Model& model, const RunOptions& options) {
  if (!options.mass_scaling.on())
    return;
  if (model.rigid.size() == model.blocks.size())
    throw geom::InputError(
        "mass_scaling: all bodies are rigid, and the mass of rigid bodies is not scaled; leave it out");
}

} // namespace cdem
