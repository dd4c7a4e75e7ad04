// All threads or one, whichever steps faster now. Results do not depend on it. Threads that wait for each other twice a
// step stand still when another program takes one of their processors: on a busy machine one alone is many times faster.
#pragma once

#include <chrono>
#include <cstdint>

namespace cdem {

class ThreadChoice {
public:
  explicit ThreadChoice(int threads) : most_(threads), threads_(threads), start_(Clock::now()) {}

  int threads() const { return threads_; }

  // After every step.
  void stepped() {
    if (most_ == 1 || ++steps_ < window(phase_))
      return;
    const auto now = Clock::now();
    const double per_step = std::chrono::duration<double>(now - start_).count() / static_cast<double>(steps_);
    start_ = now;
    steps_ = 0;
    if (phase_ == Phase::all)
      with_all_ = per_step;
    else if (phase_ == Phase::one)
      with_one_ = per_step;
    phase_ = phase_ == Phase::all ? Phase::one : phase_ == Phase::one ? Phase::best : Phase::all;
    threads_ = phase_ == Phase::one || (phase_ == Phase::best && with_one_ < with_all_) ? 1 : most_;
  }

private:
  using Clock = std::chrono::steady_clock;
  enum class Phase { all, one, best };
  static std::int64_t window(Phase phase) { return phase == Phase::best ? 2000 : 12; }

  int most_, threads_;
  Phase phase_ = Phase::all;
  std::int64_t steps_ = 0;
  double with_all_ = 0, with_one_ = 0; // s a step
  Clock::time_point start_;
};

} // namespace cdem
