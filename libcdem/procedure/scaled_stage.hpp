// A stage whose masses are scaled (integrate/mass_scaling.hpp): it raises them for a time step, again where nodes are
// freed, and gives the nodes their own mass back at its end. The kinetic energy that changes with the masses goes to the
// ledger's `fictitious`.
#pragma once

#include "libcdem/step/options.hpp"
#include "libcdem/step/stage_context.hpp"

namespace cdem {

class ScaledStage {
public:
  // step: s, the time step; 0: nothing is scaled. A stage that goes on has its masses already.
  ScaledStage(const StageContext&, double step, double safety);
  ~ScaledStage();
  ScaledStage(const ScaledStage&) = delete;
  ScaledStage& operator=(const ScaledStage&) = delete;

  bool on() const { return step_ > 0; }
  void scale(); // anew, for the nodes there are now

  // Energies of a kept state, for the share of motion in them.
  void sample();
  ScaledMasses report() const;
  // A loop carries this from step to step; the last number is the time step, s.
  void add_to(std::vector<double>& loop_state) const;
  void take(const std::vector<double>& loop_state); // the samples

private:
  void set(std::vector<double> masses);

  const StageContext& context_;
  double step_, safety_;
  double kinetic_ = 0, stored_ = 0; // J, sums over samples
};

// Throws geom::InputError: scaling with a time step, with rigid bodies.
void require_scalable(const Model&, const RunOptions&);

} // namespace cdem
