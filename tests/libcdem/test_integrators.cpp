// The two laws of motion, one component alone.
#include "libcdem/integrate/central_difference.hpp"
#include "libcdem/integrate/dynamic_relaxation.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace cdem;
using central_difference::velocity_after;

TEST_CASE("central differences: a spring swings at the frequency of the scheme and keeps its energy",
          "[integrate]") {
  // omega dt = 2 asin(dt sqrt(k / m) / 2) of the scheme
  const double m = 2, k = 50, dt = 0.1, omega = 2 * std::asin(0.5 * dt * std::sqrt(k / m)) / dt;
  double v = 0, u = 1;
  v = velocity_after(v, -k * u, m / (0.5 * dt)); // half a step
  u += dt * v;
  for (int step = 2; step <= 1000; ++step) {
    v = velocity_after(v, -k * u, m / dt);
    u += dt * v;
    CHECK(u == Approx(std::cos(omega * dt * step)).margin(1e-10));
  }
}

TEST_CASE("central differences: viscosity lets the velocity approach the one at which it holds the force",
          "[integrate]") {
  const double m = 3, c = 5, force = 7, dt = 0.01;
  double v = 0, lost = 0, work = 0;
  for (int step = 0; step < 2000; ++step) {
    const auto after = velocity_after(v, force, m / dt, c, 0);
    work += force * 0.5 * (v + after.velocity) * dt;
    lost += after.lost * dt;
    v = after.velocity;
  }
  CHECK(v == Approx(force / c));
  CHECK(work - lost == Approx(0.5 * m * v * v)); // what was not lost is kinetic
}

TEST_CASE(
    "central differences: local damping takes a part of the force against the motion, and never feeds it",
    "[integrate]") {
  const double m = 3, dt = 0.01, alpha = 0.3;
  for (const double force : {-8., 8.})
    for (const double before : {-1., -0.005, 0., 0.005, 1.}) {
      const auto after = velocity_after(before, force, m / dt, 0, alpha);
      const double mean = 0.5 * (before + after.velocity);
      CHECK(after.lost >= 0);
      CHECK(0.5 * m * (after.velocity * after.velocity - before * before) ==
            Approx((force * mean - after.lost) * dt).margin(1e-12));
      if (std::abs(before) == 1)
        CHECK(m * (after.velocity - before) / dt ==
              Approx(force - alpha * std::abs(force) * (before > 0 ? 1 : -1)));
    }
}

TEST_CASE("dynamic relaxation: force, damping and inertia balance, and the loss closes the energy",
          "[integrate]") {
  const double m = 4, c = 0.7, force = 9, before = 2;
  const DynamicRelaxation law(c);
  const double after = law.velocity_after(before, force, m), mean = 0.5 * (before + after);
  CHECK(m * (after - before) == Approx(force - c * m * mean));
  CHECK(0.5 * m * (after * after - before * before) == Approx(force * mean - law.lost(mean, m)));
}
