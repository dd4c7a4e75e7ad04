// When a relaxation has settled: its residual is below the goal now and in the mean of the last W steps, in which nothing
// broke,
//
//   W = max(10, 1/omega),   at most 200
//
// omega is the frequency, per step, of the mode that moves. A body that swings through its equilibrium is near it only
// for a moment: the mean over 1/omega steps around that moment is a quarter of the swing's peak. Joints that slip to
// and fro raise the residual of single steps but not the mean.
#pragma once

#include <cstdint>
#include <vector>

namespace cdem {

class Settled {
public:
  explicit Settled(double goal) : goal_(goal) {}

  void add(double residual);
  void start_anew() { residuals_.clear(); } // something broke or is still being moved
  bool reached(double frequency) const;     // omega

  // For a stage that goes on: numbers that a later add_to gives again. take returns the place behind them.
  void add_to(std::vector<double>& loop_state) const;
  std::size_t take(const std::vector<double>& loop_state, std::size_t from);

private:
  double goal_;
  std::vector<double> residuals_; // of the latest steps, the oldest first
};

} // namespace cdem
