// How a solution ends early: what is told, and what is left.
#include "tests/libcdem/system.hpp"

#include "libgeom/assembly/builders.hpp"
#include "libgeom/mesh/box_mesh.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace testing;
using Catch::Matchers::Contains;
using geom::Vec3;

namespace {

bool finite(const cdem::Snapshot& snapshot) {
  for (const auto* fields : {&snapshot.point_fields, &snapshot.cell_fields, &snapshot.bonds.point_fields})
    for (const cdem::SnapshotField& field : *fields)
      for (const double value : field.values)
        if (!std::isfinite(value))
          return false;
  return true;
}

// Message of the SolutionError; empty when there is none.
template <class Solve>
std::string failure(const Solve& solve) {
  try {
    solve();
  } catch (const cdem::SolutionError& e) {
    return e.what();
  }
  return "";
}

// A force there is no number after 249.5 steps of a run.
std::string failure_of_a_force_at(cdem::Simulation& s, const Vec3& place) {
  cdem::PointForce force;
  force.on = at_place(place);
  force.force = {1, 0, 0};
  const double dt = 0.9 * s.stable_time_step();
  force.amplitude = [=](double t) { return t > 249.5 * dt ? std::nan("") : 1.0; };
  s.force(force);
  cdem::RunOptions options;
  options.steps = 1000;
  return failure([&] { s.run(options); });
}

struct StopAfter : cdem::Observer {
  explicit StopAfter(int polls) : left(polls) {}
  bool stop_requested() override { return --left < 0; }
  int left;
};

} // namespace

TEST_CASE("a force that is not a number stops the run in its step and names block and place", "[failures]") {
  cdem::Simulation s = simulation(geom::grid({0.3, 0.1, 0.1}, {3, 1, 1}));
  s.fix(fixed(cdem::Selection::side("x-")));
  const std::string message = failure_of_a_force_at(s, {0.25, 0.05, 0.05}); // centroid of the third block
  CHECK_THAT(message, Contains("not a number") && Contains("stage 1 (run)") && Contains("step 251") &&
                          Contains("block 3 of body \"body\"") && Contains("(0.25, 0.05, 0.05) m"));
  CHECK(finite(s.last_good_snapshot("before")));
  CHECK(s.last_good_snapshot("before").step == 200); // the last look at everything
  CHECK(s.max("displacement.x", cdem::Selection::side("x-")).value == 0);
}

TEST_CASE("a force that is not a number on a node of a mesh stops the run and names its place",
          "[failures][mesh]") {
  const bool bonded = GENERATE(false, true);
  cdem::ModelSpec spec;
  cdem::Bonding bonding;
  bonding.everywhere = bonded;
  spec.bodies = {meshed("unit", geom::box_mesh({0.3, 0.2, 0.2}, {3, 2, 2}), bonding)};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("x-")));
  const std::string message = failure_of_a_force_at(s, {0.2, 0.1, 0.1});
  CHECK_THAT(message, Contains("not a number") && Contains("stage 1 (run)") && Contains("step 251") &&
                          Contains("of body \"unit\"") && Contains("(0.2, 0.1, 0.1) m"));
  CHECK(finite(s.last_good_snapshot("before")));
  CHECK(s.last_good_snapshot("before").step == 200);
}

TEST_CASE("a state that is not a number stops a relaxation too", "[failures]") {
  System s(build({body("rock", geom::grid({0.3, 0.1, 0.1}, {3, 1, 1}))}));
  s.hold(cdem::Selection::side("x-"), "xyz");
  s.conditions.tractions = {traction(cdem::Selection::side("x+"), {1e6, 0, 0})};
  s.relax(1e-3);
  s.state.displacement[s.model.blocks[1].centroid_node()].y = std::nan("");
  const std::string message = failure([&] { s.relax(1e-6); });
  CHECK_THAT(message,
             Contains("not a number") && Contains("(relax)") && Contains("step 1:") && Contains("block"));
}

TEST_CASE("a loaded block without supports runs away: step and block and place and advice", "[failures]") {
  cdem::Simulation s = simulation(geom::grid({0.2, 0.1, 0.1}, {2, 1, 1}));
  s.traction(traction(cdem::Selection::side("x+"), {1e6, 0, 0}));
  cdem::RelaxOptions options;
  options.breaking = false;
  const std::string message = failure([&] { s.relax(options); });
  CHECK_THAT(message, Contains("run-away displacement") && Contains("stage 1 (relax), step ") &&
                          Contains("block ") && Contains(" at (") && Contains("held by supports"));
  CHECK(finite(s.last_good_snapshot("before")));
  CHECK(s.last_good_snapshot("before").step < s.steps());
}

TEST_CASE("a block pressed through itself is an element turned inside out", "[failures]") {
  cdem::Simulation s = simulation(geom::grid({0.1, 0.1, 0.1}, {1, 1, 1}));
  s.fix(fixed(cdem::Selection::side("x-")));
  cdem::Fix press = fixed(cdem::Selection::side("x+"));
  press.displacement = Vec3(-0.11, 0, 0);
  s.fix(press);
  cdem::RelaxOptions options;
  options.breaking = false;
  const std::string message = failure([&] { s.relax(options); });
  CHECK_THAT(message,
             Contains("inside out") && Contains("stage 1 (relax), step ") && Contains("block 1 of body"));
}

TEST_CASE("stopped by the user the state is the one of the last whole step and can go on", "[failures]") {
  const auto build_bar = [](std::shared_ptr<cdem::Observer> observer) {
    cdem::Simulation s = simulation(geom::grid({0.5, 0.1, 0.1}, {5, 1, 1}), rock(), rock_joint(), observer);
    s.fix(fixed(cdem::Selection::side("x-")));
    s.traction(traction(cdem::Selection::side("x+"), {1e5, 0, 0}));
    return s;
  };
  SECTION("a run stops where an uninterrupted one of as many steps ends") {
    cdem::Simulation s = build_bar(std::make_shared<StopAfter>(20));
    cdem::RunOptions options;
    options.steps = 100000;
    CHECK_THROWS_AS(s.run(options), cdem::Interrupted);
    REQUIRE(s.steps() > 0);
    REQUIRE(s.steps() < 100000);
    cdem::Simulation whole = build_bar(nullptr);
    options.steps = s.steps();
    whole.run(options);
    CHECK(s.state_hash() == whole.state_hash());
  }
  SECTION("a relaxation leaves nothing moving and converges when called again") {
    auto observer = std::make_shared<StopAfter>(3);
    cdem::Simulation s = build_bar(observer);
    CHECK_THROWS_AS(s.relax({}), cdem::Interrupted);
    CHECK(s.max("velocity.magnitude").value == 0);
    CHECK(s.max("displacement.x").value > 0);
    observer->left = 1 << 30;
    CHECK(s.relax({}).converged);
    CHECK(s.reaction(cdem::Selection::side("x-")).x() == Approx(-1e5 * 0.01).epsilon(1e-4));
  }
}

TEST_CASE("a relaxation that does not get there says so", "[failures]") {
  cdem::Simulation s = simulation(geom::grid({0.5, 0.1, 0.1}, {5, 1, 1}));
  s.fix(fixed(cdem::Selection::side("x-")));
  s.traction(traction(cdem::Selection::side("x+"), {1e5, 0, 0}));
  cdem::RelaxOptions options;
  options.max_steps = 20;
  const cdem::RelaxResult r = s.relax(options);
  CHECK_FALSE(r.converged);
  CHECK(r.steps == 20);
  CHECK(r.residual > options.residual);
  CHECK(s.residual() == r.residual);
}
