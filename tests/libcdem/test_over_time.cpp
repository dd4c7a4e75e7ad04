// Supports and loads that follow a table in time, records and their integration, and Newmark's block.
#include "libcdem/load/record.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/core/random.hpp"
#include "tests/libcdem/boxes.hpp"
#include "tests/libcdem/going_on.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using Catch::Matchers::Contains;
using geom::Vec3;

TEST_CASE("a table over time: straight lines between its points, its ends or zero outside", "[over_time]") {
  cdem::TimeTable table{{1, 2, 4}, {10, 20, 0}, false};
  CHECK(table.at(1.5) == 15);
  CHECK(table.at(3) == 10);
  CHECK(table.at(4) == 0);
  CHECK(table.at(0) == 10);
  CHECK(table.at(9) == 0);
  table.zero_outside = true;
  CHECK(table.at(0.999) == 0);
  CHECK(table.at(1) == 10);
}

TEST_CASE("tables that are none are refused in one line each", "[over_time]") {
  const auto error = [](std::vector<double> t, std::vector<double> v) -> std::string {
    try {
      const cdem::TimeTable table{std::move(t), std::move(v), true};
      validate(table);
      cdem::require_no_gaps(table);
    } catch (const std::exception& e) {
      return e.what();
    }
    return "";
  };
  CHECK_THAT(error({0}, {1}), Contains("1 point"));
  CHECK_THAT(error({0, 1, 1}, {0, 0, 0}), Contains("point 3") && Contains("does not come after"));
  CHECK_THAT(error({0, 1, 2}, {0, std::nan(""), 0}), Contains("point 2") && Contains("finite"));
  CHECK_THAT(error({0, 1, 2, 5, 6}, {0, 0, 0, 0, 0}),
             Contains("gap from 2 to 5 s") && Contains("longest_step = 3"));
  CHECK(error({0, 1, 2, 4}, {0, 0, 0, 0}).empty());
}

TEST_CASE("an acceleration is integrated, and a straight baseline ends it at rest", "[over_time]") {
  cdem::TimeTable a;
  const double w = 3, drift = 0.2;
  for (int i = 0; i <= 4000; ++i) {
    const double t = 0.005 * i;
    a.time.push_back(t);
    a.value.push_back(std::sin(w * t) + drift);
  }
  const cdem::VelocityRecord raw = integrate(a, false);
  CHECK(raw.end_velocity == Approx((1 - std::cos(w * 20)) / w + drift * 20).epsilon(1e-4));
  CHECK(raw.end_displacement == Approx((20 - std::sin(w * 20) / w) / w + 0.5 * drift * 400).epsilon(1e-4));
  const cdem::VelocityRecord at_rest = integrate(a, true);
  CHECK(std::abs(at_rest.end_velocity) < 1e-9);
  CHECK(std::abs(at_rest.end_displacement) < 1e-8);
  CHECK(at_rest.raw_end_velocity == raw.end_velocity);
}

namespace {

// A rigid-plastic block on a horizontal base that moves by `base` (m/s): relative displacement at the end. Newmark 1965,
// integrated with steps far below those of the record.
double newmark(const cdem::Amplitude& base, double duration, double friction) {
  const double dt = 1e-5;
  double block = 0, slip = 0;
  for (int i = 0; i * dt < duration; ++i) {
    const double ground = base((i + 1) * dt), gap = ground - block, most = friction * 9.81 * dt;
    block += std::clamp(gap, -most, most);
    slip += (block - ground) * dt;
  }
  return slip;
}

struct Sliding {
  double slip, balance;
};

Sliding slide(const cdem::Amplitude& base, double duration, double angle) {
  cdem::ModelSpec spec;
  cdem::Elastic stiff = rock();
  cdem::BodySpec floor = meshed("floor", geom::box_mesh({6, 1, 0.5}, {12, 2, 1}), {}, stiff),
                 block =
                     meshed("block", box_at({1, 0.6, 0.4}, {2, 1, 1}, geom::Mat3::Identity(), {3, 0.5, 0.7}),
                            {}, stiff);
  floor.element = block.element = cdem::Element::rigid;
  spec.bodies = {floor, block};
  cdem::Joint contact = friction(angle);
  contact.normal_stiffness =
      1e10; // the slip of a contact ten times as soft is 2.6 % shorter, of one a hundred times 8 %
  contact.shear_stiffness = 1e10;
  contact.restitution = 0.1;
  spec.pairs = {{"floor", "block", contact}};
  cdem::Simulation s(spec, 1, nullptr);
  cdem::Fix moves = fixed(body_of("floor"));
  moves.velocity = Vec3::UnitX();
  moves.amplitude = [base](double t) { return base(t - 0.1); };
  s.fix(moves);
  s.gravity(gravity());
  cdem::RunOptions run;
  run.duration = duration + 0.1; // first it comes to rest under its weight
  s.run(run);
  return {s.mean("displacement.x", body_of("block")) - s.mean("displacement.x", body_of("floor")),
          s.energy().balance_error()};
}

} // namespace

TEST_CASE("Newmark's block slides as the rigid-plastic block does, under a sine and under a record",
          "[over_time][newmark]") {
  const double angle = 15, friction = std::tan(angle * degree);
  SECTION("one and a half sines") {
    const double w = 2 * pi * 2, peak = 0.5 * 9.81, end = 1.5 * 2 * pi / w;
    const cdem::Amplitude base = [=](double t) {
      return t < 0 || t > end ? 0 : peak / w * (1 - std::cos(w * std::min(t, end)));
    };
    const double expected = newmark(base, end + 1, friction);
    CHECK(std::abs(expected) > 0.03);
    const Sliding s = slide(base, end + 1, angle);
    CHECK(s.slip == Approx(expected).epsilon(0.015));
    CHECK(s.balance < 0.02);
  }
  SECTION("a record") {
    cdem::TimeTable a;
    double filtered = 0;
    for (int i = 0; i <= 400; ++i) { // coloured noise under an envelope, one-sided enough to move the block
      const double t = 0.01 * i;
      filtered = 0.8 * filtered + 0.6 * geom::normal(11, static_cast<std::uint64_t>(i), 0);
      a.time.push_back(t);
      a.value.push_back(4.0 * std::sin(pi * std::min(1.0, t / 4)) * filtered);
    }
    a.zero_outside = true;
    cdem::TimeTable velocity = integrate(a, true).velocity;
    const cdem::Amplitude base = [velocity](double t) { return velocity.at(t); };
    const double expected = newmark(base, 5, friction);
    CHECK(std::abs(expected) > 0.02);
    CHECK(slide(base, 5, angle).slip == Approx(expected).epsilon(0.03));
  }
}

TEST_CASE("a support that follows a table moves by its integral and goes on to the same bits",
          "[over_time][checkpoint]") {
  const cdem::TimeTable table{{0, 1e-3, 2e-3}, {0, 1, 0}, true};
  const auto make = [](int threads, std::shared_ptr<cdem::Observer> observer) {
    cdem::ModelSpec spec;
    spec.bodies = {meshed("bar", geom::box_mesh({0.2, 0.2, 0.4}, {2, 2, 4}))};
    return cdem::Simulation(spec, threads, std::move(observer));
  };
  const auto solve = [&](cdem::Simulation& s, int) {
    cdem::Fix moves = fixed(cdem::Selection::side("z-"));
    moves.velocity = {0.1, 0, 0};
    moves.amplitude = [table](double t) { return table.at(t); };
    s.fix(moves);
    cdem::Gravity turning;
    turning.turning = [](double t) { return Vec3(9.81 * std::sin(100 * t), 0, -9.81 * std::cos(100 * t)); };
    s.gravity(turning);
    cdem::RunOptions run;
    run.duration = 3e-3;
    s.run(run);
    CHECK(s.energy().balance_error() < 0.01);
    return Figures{s.mean("displacement.x", cdem::Selection::side("z-"))};
  };
  cdem::Simulation whole = make(1, nullptr);
  CHECK(solve(whole, 0)[0] == Approx(0.1 * 1e-3).epsilon(1e-3));
  check_going_on(make, solve, {2});
}
