// The search for the flow that breaks a held body: a coarse column on its foot, bonded everywhere.
#include "libcdem/procedure/held_pressure.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include "libgeom/core/error.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using Catch::Matchers::Contains;
using geom::Vec3;
using Reason = cdem::CriticalFlowResult::Reason;

namespace {

cdem::Simulation column(double strength, double size = 1) {
  cdem::Bonding bonding;
  bonding.everywhere = true;
  cdem::Joint joint = rock_joint();
  joint.tensile_strength = strength * 2e6;
  joint.cohesion = strength * 5e6;
  cdem::ModelSpec spec;
  spec.bodies = {
      meshed("column", geom::box_mesh(size * Vec3(0.3, 0.3, 0.75), {3, 3, 6}, 0.15), bonding, rock(), joint)};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("z-")));
  return s;
}

cdem::CriticalFlowOptions along_x(bool hold, double rate) {
  cdem::CriticalFlowOptions options;
  options.hold = hold;
  options.flow.direction = {1, 0, 0};
  options.pressure_rate = rate * 2e7;
  return options;
}

} // namespace

TEST_CASE("critical flow: hold is no higher than ramp, half the strength is 0.707 of it, size does not count",
          "[flow]") {
  const auto search = [](bool hold, double strength, double size = 1) {
    cdem::Simulation s = column(strength, size);
    cdem::CriticalFlowOptions options = along_x(hold, strength / size); // times scale with the size
    options.compliance_ratio = 1e4;
    cdem::CriticalFlowResult r = s.critical_flow(options);
    CHECK(r.reason == Reason::fragment);
    return r;
  };
  const cdem::CriticalFlowResult hold = search(true, 1), ramp = search(false, 1), half = search(true, 0.5);
  const cdem::CriticalFlowResult large = search(true, 1, 2);
  CHECK(hold.velocity <= ramp.velocity);
  CHECK(large.velocity == Approx(hold.velocity).epsilon(0.02));
  CHECK(half.velocity / hold.velocity == Approx(std::sqrt(0.5)).epsilon(0.02));
  CHECK(hold.pressure == Approx(cdem::flow_pressure(hold.velocity, 1025)));
  // Bent over, it breaks in its lower half, across the whole section at least; the largest piece is loose.
  CHECK(hold.place.z() < 0.375);
  CHECK(hold.broken_area > 0.09);
  REQUIRE(hold.fragments.size() >= 2);
  CHECK_FALSE(hold.fragments[0].held);
  CHECK(hold.fragments[0].volume >= 0.1 * 0.3 * 0.3 * 0.75);
}

TEST_CASE("critical flow: what hangs on by little has become compliant", "[flow]") {
  cdem::Simulation s = column(1);
  const cdem::CriticalFlowOptions options = along_x(true, 1);
  const cdem::CriticalFlowResult r = s.critical_flow(options);
  CHECK(r.reason == Reason::compliance);
  REQUIRE(r.curve.size() >= 2);
  const cdem::CriticalFlowSample &last = r.curve.back(), &before = r.curve[r.curve.size() - 2];
  CHECK(last.displacement >= 10 * r.compliance * last.pressure);
  CHECK(before.displacement < 10 * r.compliance * before.pressure);
  CHECK(last.velocity == r.velocity);
}

TEST_CASE("critical flow: the unbroken column's compliance and period are those of a cantilever", "[flow]") {
  const double b = 0.3, length = 1.2;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("column", geom::box_mesh({b, b, length}, {6, 6, 24}))};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("z-")));
  cdem::CriticalFlowOptions options = along_x(false, 0.01);
  options.max_velocity = 1.5;
  const cdem::CriticalFlowResult r = s.critical_flow(options);
  CHECK(r.reason == Reason::limit);
  CHECK(r.velocity == Approx(1.5).epsilon(0.02));
  CHECK(r.broken_tension + r.broken_shear == 0);
  CHECK(r.place == Vec3::Zero());
  CHECK(r.fragments.size() == 1);
  // Mean deflection under a uniform load q: q L^4 / 20 E I + q L^2 / 3 k G A. Period: 1 / omega^2 is the sum
  // of that of bending, omega_b = 3.516 sqrt(E I / rho A L^4), and of shear, omega_s = pi / 2L sqrt(k G / rho).
  const cdem::Elastic m = rock();
  const double inertia = std::pow(b, 4) / 12, area = b * b;
  const double k = 10 * (1 + m.poissons_ratio) / (12 + 11 * m.poissons_ratio), shear = k * m.shear_modulus();
  const double exact =
      b * (std::pow(length, 4) / (20 * m.youngs_modulus * inertia) + length * length / (3 * shear * area));
  const double bending2 =
      std::pow(3.516, 2) * m.youngs_modulus * inertia / (m.density * area * std::pow(length, 4));
  const double shear2 = std::pow(0.5 * pi / length, 2) * shear / m.density;
  const double period = 2 * pi * std::sqrt(1 / bending2 + 1 / shear2);
  // Constant-strain tets six to a side are too stiff by about a tenth, and never too soft; what they do to
  // the compliance they do to the square of the period.
  const double compliance_ratio = r.compliance / exact, period_ratio = r.period / period;
  INFO("compliance " << compliance_ratio << " and period " << period_ratio << " of the formula");
  CHECK(compliance_ratio < 1);
  CHECK(compliance_ratio == Approx(1).epsilon(0.15));
  CHECK(period_ratio * period_ratio == Approx(compliance_ratio).epsilon(0.02));
}

TEST_CASE("critical flow: a slender column's first bond breaks where and when beam theory says", "[flow]") {
  const double b = 0.3, length = 1.2, strength = 2e6;
  cdem::Bonding bonding;
  bonding.everywhere = true;
  cdem::Joint joint = rock_joint();
  joint.tensile_strength = strength;
  joint.cohesion = 1e9;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("column", geom::box_mesh({b, b, length}, {4, 4, 16}), bonding, rock(), joint)};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("z-")));
  const cdem::CriticalFlowResult r = s.critical_flow(along_x(true, 0.05)); // 1 MPa/s: 40 ms, five periods
  // At the root's outermost fibre the uniform load q b on the length L pulls by q b L^2 / 2 over b^3 / 6.
  const double exact = strength * b * b / (3 * length * length);
  INFO("first break at " << r.first_break_pressure << " Pa, " << r.first_break_pressure / exact
                         << " of beam theory, near " << r.first_break_place.transpose());
  CHECK(r.first_break_pressure == Approx(exact).epsilon(0.1)); // tets are stiff in bending by some per cent
  CHECK(r.first_break_velocity == Approx(cdem::flow_velocity(r.first_break_pressure, 1025)));
  CHECK(r.first_break_velocity <= r.velocity);
  CHECK(r.first_break_place.x() < 0.25 * b); // the side that the flow meets is pulled
  CHECK(r.first_break_place.z() < 0.5 * b);
}

TEST_CASE("critical flow: gravity's deflection is none of the flow's", "[flow]") {
  const auto compliance = [](const Vec3& gravity) {
    cdem::Simulation s = column(100);
    if (gravity.norm() > 0) {
      s.gravity(testing::gravity(gravity));
    }
    cdem::CriticalFlowOptions options = along_x(false, 1);
    options.max_velocity = 2;
    return s.critical_flow(options).compliance;
  };
  CHECK(compliance({5, 0, -9.81}) == Approx(compliance({0, 0, 0})).epsilon(0.01));
}

TEST_CASE("critical flow: bad input is refused", "[flow][input]") {
  const auto refused = [](const auto& set, bool held = true) {
    cdem::Simulation s = column(1);
    if (!held)
      s.release(cdem::Selection::everything(), {true, true, true});
    cdem::CriticalFlowOptions options = along_x(true, 1);
    set(options);
    return refusal([&] { s.critical_flow(options); });
  };
  const auto as_it_is = [](cdem::CriticalFlowOptions&) {};
  CHECK_THAT(refused(as_it_is, false), Contains("nothing is held") && Contains("fix"));
  CHECK_THAT(refused([](auto& o) { o.held = cdem::Selection::side("z+"); }),
             Contains("held = z+") && Contains("it is free"));
  CHECK_THAT(refused([](auto& o) { o.held = cdem::Selection::side("x+"); }), Contains("held = x+"));
  CHECK(refused([](auto& o) { o.held = cdem::Selection::side("z-"); }).empty());
  CHECK_THAT(refused([](auto& o) { o.flow.direction.setZero(); }),
             Contains("direction") && Contains("longer than"));
  CHECK_THAT(refused([](auto& o) { o.flow.on = {cdem::Selection::side("x+")}; }),
             Contains("looks towards the flow"));
  CHECK_THAT(refused([](auto& o) { o.flow.water_density = 0; }), Contains("water_density = 0"));
  CHECK_THAT(refused([](auto& o) { o.pressure_rate = 0; }), Contains("pressure_rate = 0"));
  CHECK_THAT(refused([](auto& o) { o.hold_periods = -1; }), Contains("hold_periods = -1"));
  CHECK_THAT(refused([](auto& o) { o.fragment_fraction = 1; }), Contains("fragment_fraction = 1"));
  CHECK_THAT(refused([](auto& o) { o.compliance_ratio = 1; }), Contains("compliance_ratio = 1"));
  CHECK_THAT(refused([](auto& o) { o.max_velocity = std::nan(""); }), Contains("max_velocity = nan"));
}

TEST_CASE(
    "a pressure rises at its rate up to its limit, but for holds, after which it goes on from where it was") {
  cdem::HeldPressure pressure{2, 100, 10, 150};
  CHECK(pressure.at(2) == 100);
  CHECK(pressure.at(5) == 130);
  CHECK(pressure.at(9) == 150);
  pressure.hold(4, 6);
  CHECK(pressure.resume == 6);
  CHECK(pressure.at(4) == 120);
  CHECK(pressure.at(6) == 120);
  pressure.go_on(6.5);
  CHECK(pressure.at(6.5) == 120);
  CHECK(pressure.at(8.5) == 140);
  CHECK(pressure.at(20) == 150);
}
