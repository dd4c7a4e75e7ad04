// A body that nothing holds falls as u = v0 t + g t^2 / 2: central differences are exact under a constant force, if the
// first kick, from velocities at the time of the displacements, is one of half a step.
#include "tests/libcdem/system.hpp"

#include "libcdem/results/energy.hpp"
#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

const Vec3 falling(0.3, -0.5, -9.81); // m/s2

System falling_grid(const Vec3& v0) {
  System s(build({body("block", geom::grid({0.2, 0.1, 0.1}, {2, 1, 1}))}));
  s.conditions.gravity = gravity(falling);
  for (cdem::Node& v : s.state.velocity)
    v = node(v0);
  return s;
}

double largest_error(const System& s, const Vec3& v0) {
  const double t = s.state.time;
  const Vec3 way = v0 * t + 0.5 * t * t * falling;
  double error = 0;
  for (const cdem::Node& u : s.state.displacement)
    error = std::max(error, (vec(u) - way).norm() / way.norm());
  return error;
}

cdem::RunOptions run_for(std::int64_t steps, double safety = 0.9) {
  cdem::RunOptions options;
  options.steps = steps;
  options.safety = safety;
  return options;
}

} // namespace

TEST_CASE("free fall covers g t^2 / 2 to 1e-12 after any number of steps", "[run]") {
  System s = falling_grid(Vec3::Zero());
  s.run(run_for(GENERATE(1, 2, 3, 10, 1000)));
  CHECK(largest_error(s, Vec3::Zero()) < 1e-12);
}

TEST_CASE("a throw covers v0 t + g t^2 / 2 through runs of different time steps", "[run]") {
  const Vec3 v0(0.002, 0, 0.001);
  System s = falling_grid(v0);
  s.run(run_for(1, 0.9));
  s.run(run_for(7, 0.2));
  s.run(run_for(50, 0.9));
  CHECK(largest_error(s, v0) < 1e-12);
}

TEST_CASE("what falls from rest has the work of gravity as kinetic energy from the first step on", "[run]") {
  System s = falling_grid(Vec3::Zero());
  s.run(run_for(GENERATE(1, 2, 25)));
  const cdem::EnergyLedger e = cdem::energy(s.model, s.state);
  const double mass = rock().density * 2e-3, t = s.state.time - s.state.velocity_lag;
  CHECK(e.kinetic == Approx(0.5 * mass * falling.squaredNorm() * t * t).epsilon(1e-12));
  CHECK(e.external == Approx(e.kinetic).epsilon(1e-12));
}

TEST_CASE("a run after a relaxation starts from rest, with half a kick", "[run]") {
  System s = falling_grid(Vec3::Zero());
  s.hold(cdem::Selection::everything(), "xyz");
  s.run(run_for(3));
  REQUIRE(s.state.velocity_lag > 0);
  s.relax(1e-6);
  s.conditions.fixes.clear();
  const double start = s.state.time;
  s.run(run_for(20));
  const double t = s.state.time - start;
  for (const cdem::Node& u : s.state.displacement)
    CHECK((vec(u) - 0.5 * t * t * falling).norm() < 1e-12 * t * t * falling.norm());
}
