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
  CHECK(left.steps_per_second() == Approx(steps_per_second).epsilon(0.01));
  CHECK(left.fraction() == Approx((wall - interval) / 12).epsilon(1e-6));
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
