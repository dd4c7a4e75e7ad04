// The verdict of a relaxation: stable, failing, undecided. Looks of known motions first, then models.
#include "tests/libcdem/system.hpp"

#include "libcdem/joint/strength_reduction.hpp"
#include "libcdem/procedure/reduce_strength.hpp"
#include "libcdem/procedure/stability.hpp"
#include "libcdem/results/contact_points.hpp"
#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

using namespace testing;
using cdem::Verdict;
using geom::Vec3;

namespace {

// Looks every 200 steps at a motion x(n) with the force out of balance r(n); work 1 per length, the stored part of it.
// The step at which it was found to fail, -1: never.
std::int64_t found_failing(double period, const std::function<double(double)>& path,
                           const std::function<double(double)>& residual,
                           const std::function<double(double)>& stored) {
  cdem::StabilityWatch watch(period, 1e3);
  for (int look = 1; look <= 200; ++look) {
    const double n = 200.0 * look;
    watch.add({200 * look, path(n), residual(n), path(n), stored(n)});
    if (watch.failing())
      return 200 * look;
  }
  return -1;
}

constexpr double g = 9.81, phi = 30 * degree;

// Two blocks that slide over a held base.
cdem::Simulation slope(double steepness, double cohesion = 0, double friction_angle = phi) {
  cdem::ModelSpec spec;
  cdem::Joint contact = rock_joint();
  contact.bonded = cohesion > 0;
  contact.cohesion = cohesion;
  contact.tensile_strength = 0;
  contact.friction_angle = friction_angle;
  spec.bodies = {body("base", geom::grid({1.4, 0.5, 0.1}, {1, 1, 1}, {-0.2, 0, -0.1})),
                 body("slider", geom::grid({1, 0.5, 0.1}, {2, 1, 1}))};
  spec.pairs = {{"base", "slider", contact}};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::of_body("base")));
  s.gravity(gravity(g * Vec3(std::sin(steepness), 0, -std::cos(steepness))));
  return s;
}

cdem::RelaxResult relax_slope(cdem::Simulation& s, double residual = 1e-6, std::int64_t max_steps = 200000) {
  cdem::RelaxOptions options;
  options.residual = residual;
  options.max_steps = max_steps;
  options.stop_on_failure = true;
  return s.relax(options);
}

} // namespace

TEST_CASE("what speeds up or drifts under a load that nothing stores is failing", "[stability]") {
  const auto constant = [](double) { return 0.1; };
  const auto nothing = [](double) { return 0.0; };
  const std::int64_t fall = found_failing(
      300, [](double n) { return 1e-9 * n * n; }, constant, nothing);
  CHECK(fall >= 4 * 300);
  CHECK(fall <= 4 * 300 + 800);
  CHECK(found_failing(
            300, [](double n) { return 1e-6 * n; }, constant, nothing) > 0);
  // After a settlement as large as 5000 steps of it.
  const std::int64_t later = found_failing(
      300, [](double n) { return 5e-3 * (1 - std::exp(-n / 300)) + 1e-6 * n; }, constant,
      [](double n) { return 2.5e-3 * (1 - std::exp(-n / 300)); });
  CHECK(later > 1500);
}

TEST_CASE("slow convergence and the swings of an elastic body are not failing", "[stability]") {
  // Creeps to its place, with time constants below and above the looks; nothing stored, as where it rubs.
  for (const double time : {100.0, 400.0, 1000.0}) {
    CAPTURE(time);
    CHECK(found_failing(
              300, [&](double n) { return 1 - std::exp(-n / time); },
              [&](double n) { return std::exp(-n / time); }, [](double) { return 0.0; }) == -1);
  }
  // An undamped swing of up to ten times the period that a rod would have: path, force and energy of a spring.
  for (const double times : {0.5, 1.0, 3.0, 10.0}) {
    CAPTURE(times);
    const double w = 2 * pi / (times * 1500);
    const auto swing = [&](double n) { return 1 - std::cos(w * n); };
    const auto path = [&](double n) {
      const double half = std::floor(n * w / pi);
      return 2 * half + (std::fmod(half, 2) == 0 ? swing(n) : 2 - swing(n));
    };
    cdem::StabilityWatch watch(1500, 1e3);
    bool failing = false;
    for (int look = 1; look <= 300; ++look) {
      const double n = 200.0 * look;
      watch.add({200 * look, path(n), std::abs(std::cos(w * n)), swing(n), 0.5 * swing(n) * swing(n)});
      failing = failing || watch.failing();
    }
    CHECK_FALSE(failing);
  }
}

TEST_CASE("a block on an incline is stable below its friction angle and failing above", "[stability]") {
  for (const double apart : {-5.0, -1.0, -0.2}) {
    CAPTURE(apart);
    cdem::Simulation s = slope(phi + apart * degree);
    const cdem::RelaxResult r = relax_slope(s);
    CHECK(r.verdict == Verdict::stable);
    CHECK(r.converged);
  }
  for (const double apart : {0.2, 1.0, 5.0, 30.0}) {
    CAPTURE(apart);
    cdem::Simulation s = slope(phi + apart * degree);
    const cdem::RelaxResult r = relax_slope(s);
    CAPTURE(r.steps);
    CHECK(r.verdict == Verdict::failing);
    CHECK_FALSE(r.converged);
    CHECK(r.steps < 20000);
    CHECK(r.moving > 0);
    CHECK(r.moving_place.z() >= 0); // of the slider
    CHECK(s.max("displacement.magnitude").value > 0);
    CHECK(s.snapshot("after").step == s.steps());
  }
}

TEST_CASE("a relaxation that ends before it knows is undecided", "[stability]") {
  cdem::Simulation s = slope(phi + 5 * degree);
  const cdem::RelaxResult r = relax_slope(s, 1e-6, 50);
  CHECK(r.verdict == Verdict::undecided);
  CHECK(r.steps == 50);
}

TEST_CASE("a slender column that bends slowly is stable", "[stability]") {
  cdem::Simulation s = simulation(geom::grid({4, 0.2, 0.2}, {20, 1, 1}));
  s.fix(fixed(cdem::Selection::side("x-")));
  s.gravity(gravity(Vec3(0, 0, -g)));
  cdem::RelaxOptions options;
  options.breaking = false;
  options.stop_on_failure = true;
  const cdem::RelaxResult r = s.relax(options);
  CAPTURE(r.steps);
  CHECK(r.verdict == Verdict::stable);
}

TEST_CASE("reduced strengths are c / F, tan(phi) / F and sigma_t / F", "[stability]") {
  const cdem::Joint joint = rock_joint(), less = cdem::reduced(joint, 1.5);
  CHECK(less.cohesion == Approx(joint.cohesion / 1.5));
  CHECK(std::tan(less.friction_angle) == Approx(std::tan(joint.friction_angle) / 1.5));
  CHECK(less.tensile_strength == Approx(joint.tensile_strength / 1.5));
  CHECK(cdem::reduced(cdem::glued_joint(), 2).cohesion == cdem::glued_joint().cohesion);
}

TEST_CASE("a copy goes its own way, and reduced strength makes it slide", "[stability]") {
  cdem::Simulation s = slope(25 * degree);
  REQUIRE(relax_slope(s).verdict == Verdict::stable);
  const std::uint64_t before = s.state_hash();
  cdem::Simulation other = s.copy();
  CHECK(other.state_hash() == before);
  const double exact = std::tan(phi) / std::tan(25 * degree);
  other.reduce_strength(1.01 * exact, {true, false});
  CHECK(relax_slope(other).verdict == Verdict::failing);
  CHECK(s.state_hash() == before);
  cdem::Simulation third = s.copy();
  third.reduce_strength(0.99 * exact, {true, false});
  CHECK(relax_slope(third).verdict == Verdict::stable);
}

TEST_CASE("a model without strength cannot be reduced", "[stability]") {
  cdem::Simulation s = slope(5 * degree, 0, 0);
  cdem::Model smooth = build({body("one", geom::grid({1, 1, 1}, {1, 1, 1}))});
  CHECK_THROWS_WITH(cdem::reduce_strength(smooth, 1.2, {true, false}),
                    Catch::Matchers::Contains("no strength to reduce"));
  CHECK_THROWS_WITH(s.reduce_strength(0, {true, false}), Catch::Matchers::Contains("factor = 0"));
}

namespace {

cdem::Joint rough(double friction_angle = phi) {
  cdem::Joint contact = rock_joint();
  contact.bonded = false;
  contact.cohesion = contact.tensile_strength = 0;
  contact.friction_angle = friction_angle;
  return contact;
}

constexpr double incline = 21 * degree;

// A block that stands and a stone, on a base that is held below.
cdem::Simulation stone_beside_block(double size, double friction_angle) {
  cdem::ModelSpec spec;
  spec.bodies = {body("base", geom::grid({6, 6, 3}, {1, 1, 1}, {-3, -3, -3})),
                 body("block", geom::grid({2, 2, 1}, {1, 1, 1}, {-2, -1, 0})),
                 body("stone", geom::grid({size, size, size / 2}, {1, 1, 1}, {1, 0, 0}))};
  spec.pairs = {{"base", "block", rough()}, {"base", "stone", rough(friction_angle)}};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("z-")));
  s.gravity(gravity(g * Vec3(std::sin(incline), 0, -std::cos(incline))));
  return s;
}

} // namespace

TEST_CASE("a stone that slides beside a large block is failing, however small it is", "[stability]") {
  for (const double size : {0.02, 0.1, 0.2, 1.0}) {
    CAPTURE(size);
    cdem::Simulation slides = stone_beside_block(size, std::atan(0.98 * std::tan(incline)));
    const cdem::RelaxResult r = relax_slope(slides, 1e-5);
    CHECK(r.verdict == Verdict::failing);
    CHECK(r.moving_place.x() >= 1); // of the stone
    cdem::Simulation stands = stone_beside_block(size, std::atan(1.02 * std::tan(incline)));
    CHECK(relax_slope(stands, 1e-5).verdict == Verdict::stable);
  }
}

TEST_CASE("a pebble follows the block that settles under it", "[stability]") {
  constexpr double size = 0.01;
  cdem::ModelSpec spec;
  spec.bodies = {body("base", geom::grid({10, 10, 10}, {1, 1, 1}, {-5, -5, -10})),
                 body("pebble", geom::grid({size, size, size / 2}, {1, 1, 1}, {0.31, 0.17, 1e-5}))};
  spec.bodies[0].element = spec.bodies[1].element = cdem::Element::finite_volume;
  spec.pairs = {{"base", "pebble", rough()}};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("z-")));
  s.gravity(gravity(Vec3(0, 0, -g)));
  REQUIRE(relax_slope(s).verdict == Verdict::stable);
  double carried = 0; // N
  for (const cdem::ContactPoint& point : cdem::contact_points(s.model(), s.state()))
    carried += point.normal.norm();
  CHECK(carried == Approx(rock().density * g * size * size * size / 2).epsilon(0.01));
}

TEST_CASE("a body that no load acts on does not keep a relaxation going", "[stability]") {
  cdem::ModelSpec spec;
  spec.bodies = {body("base", geom::grid({1, 1, 1}, {1, 1, 1}, {0, 0, -1})),
                 body("stone", geom::grid({0.1, 0.1, 0.1}, {1, 1, 1}, {0.3, 0.4, 0}))};
  spec.pairs = {{"base", "stone", rough()}};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("z-")));
  s.traction(traction(cdem::Selection::side("x+"), Vec3(-1e6, 0, 0))); // the base swells upwards
  s.traction(traction(cdem::Selection::side("x-"), Vec3(1e6, 0, 0)));
  CHECK(relax_slope(s).verdict == Verdict::stable);
}
