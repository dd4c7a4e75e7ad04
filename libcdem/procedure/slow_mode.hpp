// The frequency of the slow mode of a relaxation, which sets its damping. It is the Rayleigh quotient of the
// displacement D of the nodes in the last 20 steps,
//
//   omega^2 = -D . dF / (D . M D),   dF the change of the net force along it
//
// Joints that slip to and fro and contacts that close ring at high frequencies. In a single step they may outweigh the slow
// mode, which is then damped far beyond what is critical for it, and creeps; over 20 steps they cancel out.
#pragma once

#include "libcdem/state/state.hpp"
#include "libcdem/step/stage.hpp"

#include <optional>

namespace cdem {

inline constexpr std::int64_t slow_mode_every = 20; // steps of the model
static_assert(watch_every % slow_mode_every == 0, "a stage is left where it has just looked");

class SlowMode {
public:
  // After every slow_mode_every steps; force: the net forces before the last step, N; mass: kg for a unit step.
  void look(const State&, const std::vector<Node>& force, const std::vector<double>& mass);
  // The displacement counts from the positions of the nodes when these forces acted.
  void start(const State&, const std::vector<Node>& force);
  void forget() { *this = {}; }
  // As the last look found it, per step squared; none: there was no look, or nothing has moved.
  std::optional<double> frequency2() const { return frequency2_; }
  void take(double frequency2); // < 0: none

private:
  std::vector<Node> from_, force_; // m, N
  std::optional<double> frequency2_;
};

} // namespace cdem
