// Leaving a model in the middle of a stage and going on from there, to the same bits as without.
#pragma once

#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>

namespace testing {

// Saves at the given look and, when told to, stops there.
struct Saver final : cdem::CheckpointWriter {
  cdem::Simulation* simulation = nullptr;
  int look = 0, save_at = 0;
  std::string saved;
  bool wanted() override { return ++look == save_at; }
  void write(bool) override { saved = simulation->save(); }
};

struct Stopper final : cdem::Observer {
  int polls = 0, stop_at = 1 << 30;
  bool stop_requested() override { return ++polls >= stop_at; }
};

inline void check_same(const cdem::Simulation& a, const cdem::Simulation& b) {
  CHECK(a.state_hash() == b.state_hash());
  CHECK(a.stage() == b.stage());
  CHECK(a.steps() == b.steps());
  CHECK(a.residual() == b.residual());
  CHECK(a.energy().total() == b.energy().total());
  REQUIRE(a.log().breaks.size() == b.log().breaks.size());
  for (std::size_t i = 0; i < a.log().breaks.size(); ++i)
    CHECK((a.log().breaks[i].step == b.log().breaks[i].step &&
           a.log().breaks[i].place == b.log().breaks[i].place &&
           a.log().breaks[i].stage == b.log().breaks[i].stage));
  REQUIRE(a.log().history.size() == b.log().history.size());
  for (std::size_t i = 0; i < a.log().history.size(); ++i)
    CHECK((a.log().history[i].step == b.log().history[i].step &&
           a.log().history[i].kinetic == b.log().history[i].kinetic &&
           a.log().history[i].broken_tension == b.log().history[i].broken_tension));
}

// Results of stages.
using Figures = std::vector<double>;

// build(threads, observer) makes a model, solve(s, done) runs its stages after the first `done` and returns what came
// of the last. Left at these looks, of which there is one every 16 steps, it must go on to the same.
template <class Build, class Solve>
void check_going_on(const Build& build, const Solve& solve,
                    const std::vector<int>& looks = {1, 15, 40, 100}) {
  cdem::Simulation whole = build(1, nullptr);
  const Figures figures = solve(whole, 0);
  for (const int look : looks) {
    INFO("left at look " << look);
    for (const bool stop : {false, true}) {
      INFO((stop ? "stopped" : "went on"));
      auto observer = std::make_shared<Stopper>();
      cdem::Simulation left = build(1, observer);
      Saver saver;
      saver.simulation = &left;
      (stop ? observer->stop_at : saver.save_at) = look;
      left.set_checkpoint_writer(&saver);
      if (stop)
        REQUIRE_THROWS_AS(solve(left, 0), cdem::Interrupted);
      else
        solve(left, 0);
      REQUIRE_FALSE(saver.saved.empty());
      if (!stop)
        check_same(left, whole); // taking one changes nothing
      for (const int threads : {1, 2}) {
        cdem::Simulation next = build(threads, nullptr);
        next.restore(saver.saved);
        CHECK(solve(next, next.stage()) == figures);
        check_same(next, whole);
      }
    }
  }
}

} // namespace testing
