#include "apps/cdem/progress/time_left.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using cdem::Progress;
using cdem::app::TimeLeft;

namespace {

constexpr double steps_per_second = 1000, interval = 0.1;

Progress relaxation(double wall) {
  Progress p;
  p.stage = 1;
  p.kind = "relax";
  p.step = std::llround(wall * steps_per_second);
  p.max_steps = 500000;
  p.residual_goal = 1e-6;
  return p;
}

// Of units that settle, within a minute of the model's time and 1e-4 s a step.
Progress settling(double wall) {
  Progress p = relaxation(wall);
  p.kind = "settle";
  p.residual_goal = 0;
  p.kinetic_ratio_goal = 1e-6;
  p.time = 1e-4 * static_cast<double>(p.step);
  p.time_goal = 60;
  p.max_steps = 600000;
  return p;
}

} // namespace

TEST_CASE("a residual that falls exponentially gives the time left") {
  // residual = 10^(-step / 2000): 1e-6 after 12000 steps, 12 s.
  TimeLeft left;
  double wall = 0;
  for (; wall < 5; wall += interval) {
    Progress p = relaxation(wall);
    p.residual = std::pow(10, -static_cast<double>(p.step) / 2000);
    left.add(p, wall);
  }
  CHECK(left.seconds() == Approx(12 - (wall - interval)).epsilon(1e-6));
  CHECK_FALSE(left.gives_up());
  CHECK(left.steps_per_second() == Approx(steps_per_second).epsilon(0.01));
  CHECK(left.fraction() == Approx((wall - interval) / 12).epsilon(1e-6));
}

TEST_CASE("a residual that would reach its goal after the last step gives the time to that") {
  TimeLeft left;
  double wall = 0;
  for (; wall < 5; wall += interval) {
    Progress p = relaxation(wall);
    p.max_steps = 10000;
    p.residual = std::pow(10, -static_cast<double>(p.step) / 2000);
    left.add(p, wall);
  }
  CHECK(left.gives_up());
  CHECK(left.seconds() == Approx(10 - (wall - interval)).epsilon(1e-6));
}

TEST_CASE("ripples and outliers of the residual move the time left little") {
  TimeLeft left;
  double wall = 0;
  int call = 0;
  for (; wall < 6; wall += interval, ++call) {
    Progress p = relaxation(wall);
    p.residual = std::pow(10, -static_cast<double>(p.step) / 2000 + 0.3 * std::sin(0.7 * call));
    if (call % 10 == 0)
      p.residual *= 100;
    left.add(p, wall);
  }
  CHECK(left.seconds() == Approx(6).epsilon(0.2));
}

TEST_CASE("a long stage is thinned, and its estimate stays right") {
  TimeLeft left;
  double wall = 0;
  for (; wall < 1000; wall += interval) { // 10^(-step / 4e5): 2.4e6 steps, 2400 s
    Progress p = relaxation(wall);
    p.max_steps = 100000000;
    p.residual = std::pow(10, -static_cast<double>(p.step) / 4e5);
    left.add(p, wall);
  }
  CHECK(left.seconds() == Approx(1400).epsilon(1e-3));
}

TEST_CASE("a residual that does not fall gives no time left") {
  TimeLeft left;
  for (double wall = 0; wall < 5; wall += interval) {
    Progress p = relaxation(wall);
    p.residual = 1e-3 * (1 + 0.01 * wall);
    left.add(p, wall);
  }
  CHECK(left.seconds() < 0);
}

TEST_CASE("a residual that falls too slowly is bounded by the limit of steps") {
  TimeLeft left;
  double wall = 0;
  for (; wall < 5; wall += interval) {
    Progress p = relaxation(wall);
    p.max_steps = 10000;
    p.residual = std::pow(10, -static_cast<double>(p.step) / 1e6);
    left.add(p, wall);
  }
  CHECK(left.seconds() == Approx(10 - (wall - interval)).epsilon(0.02));
}

TEST_CASE("a stage with an end time goes by the time it has reached") {
  TimeLeft left;
  for (int i = 0; i <= 10; ++i) {
    Progress p;
    p.stage = 2;
    p.kind = "run";
    p.step = 100 * i;
    p.time = 0.01 * i;
    p.time_goal = 0.4;
    left.add(p, 0.5 * i);
  }
  CHECK(left.seconds() == Approx(15)); // 5 s for a quarter
  CHECK(left.fraction() == Approx(0.25));
}

TEST_CASE("a stage that begins later counts its own time only") {
  TimeLeft left;
  for (int i = 0; i <= 10; ++i) {
    Progress p;
    p.stage = 2;
    p.step = 100 * i;
    p.time_start = 100;
    p.time = 100 + 0.01 * i;
    p.time_goal = 100.4;
    left.add(p, 0.5 * i);
  }
  CHECK(left.seconds() == Approx(15));
  CHECK(left.fraction() == Approx(0.25));
}

TEST_CASE("units that settle are at rest when their kinetic energy has fallen, not at the limit of time") {
  // ratio = 10^(-step / 2000) with the ripples of impacts: 1e-6 after 12 s; the limit is 600 s away.
  TimeLeft left;
  double wall = 0;
  int call = 0;
  for (; wall < 6; wall += interval, ++call) {
    Progress p = settling(wall);
    p.kinetic_ratio = std::pow(10, -static_cast<double>(p.step) / 2000 + 0.3 * std::sin(0.7 * call));
    left.add(p, wall);
  }
  CHECK(left.seconds() == Approx(6).epsilon(0.2));
  CHECK(left.fraction() == Approx(0.5).margin(0.1)); // ripples of 0.3 of six decades, at the top and now
}

TEST_CASE("units that still fall, at their peak of kinetic energy, give no time left") {
  TimeLeft left;
  for (double wall = 0; wall < 5; wall += interval) {
    Progress p = settling(wall);
    p.kinetic_ratio = 1;
    left.add(p, wall);
  }
  CHECK(left.seconds() < 0);
  CHECK(left.fraction() == Approx(0).margin(1e-12));
}

TEST_CASE("of two goals the one that is reached later counts") {
  // The kinetic energy is low from the start; residual = 10^(-step / 4000): 0.01 after 8 s.
  TimeLeft left;
  double wall = 0;
  for (; wall < 4; wall += interval) {
    Progress p = settling(wall);
    p.kinetic_ratio = 1e-7;
    p.residual_goal = 0.01;
    p.residual = std::pow(10, -static_cast<double>(p.step) / 4000);
    left.add(p, wall);
  }
  CHECK(left.seconds() == Approx(8 - (wall - interval)).epsilon(1e-6));
  CHECK(left.fraction() == Approx((wall - interval) / 8).epsilon(1e-6));
}

TEST_CASE("the next stage starts without memory of the one before") {
  TimeLeft left;
  for (double wall = 0; wall < 5; wall += interval) {
    Progress p = relaxation(wall);
    p.residual = std::pow(10, -wall);
    left.add(p, wall);
  }
  REQUIRE(left.seconds() > 0);
  Progress next = relaxation(0);
  next.stage = 2;
  next.residual = 1;
  left.add(next, 0);
  CHECK(left.seconds() < 0);
  CHECK(left.fraction() == Approx(0).margin(1e-12));
}

TEST_CASE("NaN residuals are left out") {
  TimeLeft left;
  for (double wall = 0; wall < 5; wall += interval) {
    Progress p = relaxation(wall);
    p.residual = std::nan("");
    left.add(p, wall);
  }
  CHECK(left.seconds() < 0);
  CHECK(left.fraction() < 0);
}
