// What a Simulation refuses: each error names the field, its value, what is allowed and what to do.
#include "tests/libcdem/system.hpp"

#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/error.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace testing;
using Catch::Matchers::Contains;
using geom::InputError;
using geom::Vec3;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

geom::Assembly bar() {
  return geom::grid({0.2, 0.1, 0.1}, {2, 1, 1});
}
cdem::Selection nowhere() {
  return cdem::Selection::in_box({{5, 5, 5}, {6, 6, 6}});
}
cdem::Selection all() {
  return cdem::Selection::everything();
}

std::string refused_material(double cdem::Elastic::*field, double value) {
  cdem::Elastic material = rock();
  material.*field = value;
  return refusal([&] { simulation(bar(), material); });
}

std::string refused_joint(double cdem::Joint::*field, double value) {
  cdem::Joint joint = rock_joint();
  joint.*field = value;
  return refusal([&] { simulation(bar(), rock(), joint); });
}

std::string refused_joint(std::optional<double> cdem::Joint::*field, double value) {
  cdem::Joint joint = rock_joint();
  joint.*field = value;
  return refusal([&] { simulation(bar(), rock(), joint); });
}

std::string refused(const cdem::ModelSpec& spec, int threads = 1) {
  return refusal([&] { cdem::Simulation(spec, threads, nullptr); });
}

} // namespace

TEST_CASE("materials that cannot be are refused", "[input]") {
  for (const double bad : {0.0, -1.0, not_a_number, infinite}) {
    CHECK_THAT(refused_material(&cdem::Elastic::youngs_modulus, bad),
               Contains("youngs_modulus = ") && Contains("> 0 Pa"));
    CHECK_THAT(refused_material(&cdem::Elastic::density, bad),
               Contains("density = ") && Contains("> 0 kg/m3"));
  }
  for (const double bad : {0.5, 0.7, -1.0, not_a_number})
    CHECK_THAT(refused_material(&cdem::Elastic::poissons_ratio, bad),
               Contains("poissons_ratio = ") && Contains("in (-1, 0.5)"));
  for (const double bad : {-1.0, not_a_number, infinite})
    CHECK_THAT(refused_material(&cdem::Elastic::viscosity, bad),
               Contains("viscosity = ") && Contains(">= 0"));
}

TEST_CASE("joints that cannot be are refused", "[input]") {
  for (const double bad : {-1.0, not_a_number, infinite}) {
    CHECK_THAT(refused_joint(&cdem::Joint::cohesion, bad), Contains("cohesion = ") && Contains(">= 0 Pa"));
    CHECK_THAT(refused_joint(&cdem::Joint::tensile_strength, bad),
               Contains("tensile_strength = ") && Contains(">= 0 Pa"));
  }
  CHECK_THAT(refused_joint(&cdem::Joint::friction_angle, pi / 2),
             Contains("friction_angle = 90: must be in [0, 90)"));
  CHECK_THAT(refused_joint(&cdem::Joint::friction_angle, -0.1), Contains("friction_angle = "));
  CHECK_THAT(refused_joint(&cdem::Joint::friction_angle, not_a_number), Contains("friction_angle = "));
  for (const double bad : {0.0, -0.1, 1.5, not_a_number})
    CHECK_THAT(refused_joint(&cdem::Joint::thickness_ratio, bad),
               Contains("thickness_ratio = ") && Contains("(0, 1]"));
  for (const double bad : {0.0, -1.0, not_a_number, infinite}) {
    CHECK_THAT(refused_joint(&cdem::Joint::thickness, bad), Contains("thickness = ") && Contains("> 0 m"));
    CHECK_THAT(refused_joint(&cdem::Joint::normal_stiffness, bad),
               Contains("normal_stiffness = ") && Contains("> 0 Pa/m"));
    CHECK_THAT(refused_joint(&cdem::Joint::shear_stiffness, bad),
               Contains("shear_stiffness = ") && Contains("> 0 Pa/m"));
  }
}

TEST_CASE("models that do not hang together are refused", "[input]") {
  const auto right = geom::grid({0.1, 0.1, 0.1}, {1, 1, 1}, {0.2, 0, 0});
  cdem::ModelSpec spec;
  CHECK_THAT(refused(spec), Contains("bodies = ") && Contains("at least one body"));
  spec.bodies = {body("left", bar()), body("left", right)};
  CHECK_THAT(refused(spec), Contains("name = \"left\"") && Contains("unique"));
  spec.bodies[1].name = "right";
  CHECK_THAT(refused(spec), Contains("\"left\"") && Contains("\"right\"") && Contains("touch but no joint") &&
                                Contains("contacts"));
  spec.pairs = {{"left", "rigth", rock_joint()}};
  CHECK_THAT(refused(spec), Contains("\"rigth\"") && Contains("\"left\", \"right\""));
  spec.pairs[0].body_b = "right";
  CHECK(refused(spec).empty());
  CHECK_THAT(refused(spec, 0), Contains("threads = 0") && Contains(">= 1"));
  spec.pairs[0].joint.cohesion = -1;
  CHECK_THAT(refused(spec), Contains("cohesion = -1"));
  spec.pairs[0].joint.cohesion = 1;
  spec.bodies[1].shape.blocks.clear();
  CHECK_THAT(refused(spec), Contains("shape = ") && Contains("at least one block"));
}

TEST_CASE("conditions that select nothing are refused and change nothing", "[input]") {
  cdem::Simulation s = simulation(bar());
  cdem::Fix fix;
  fix.on = nowhere();
  CHECK_THAT(refusal([&] { s.fix(fix); }), Contains("on = box from (5, 5, 5)") && Contains("holds nodes"));
  CHECK_THAT(refusal([&] { s.release(nowhere(), axes("x")); }), Contains("on = box from (5, 5, 5)"));
  cdem::Traction traction;
  traction.on = cdem::Selection::on_plane(geom::Plane::through({0.1, 0, 0}, {1, 0, 0})); // inside, covered
  CHECK_THAT(refusal([&] { s.traction(traction); }), Contains("on = plane") && Contains("outer faces"));
  cdem::PointForce force;
  force.on = at_place({0.123, 0, 0});
  CHECK_THAT(refusal([&] { s.force(force); }), Contains("on = a place") && Contains("holds nodes"));
  CHECK_THAT(refusal([&] {
               s.initial_stress(nowhere(), {1, 0, 0, 0, 0, 0});
             }),
             Contains("holds block centroids"));
  CHECK_THAT(refusal([&] { s.initial_velocity(nowhere(), {1, 0, 0}); }), Contains("holds nodes"));
  CHECK_THAT(refusal([&] { s.remove(nowhere()); }), Contains("holds block centroids"));
  CHECK_THAT(refusal([&] { s.remove(all()); }), Contains("leaves nothing to solve"));
  CHECK_THAT(refusal([&] { s.break_bonds(nowhere()); }), Contains("holds bonds"));
  CHECK_THAT(refusal([&] { fix.on = cdem::Selection::of_body("nobody"), s.fix(fix); }),
             Contains("body \"nobody\""));
  CHECK_THAT(refusal([] { cdem::Selection::side("w+"); }),
             Contains("\"w+\"") && Contains("x- x+ y- y+ z- z+"));
  CHECK_THAT(refusal([] { cdem::Selection::side("x"); }), Contains("\"x\""));
  // None of them stays behind.
  cdem::RunOptions options;
  options.steps = 1;
  s.run(options);
  CHECK(s.max("displacement.magnitude").value == 0);
}

TEST_CASE("numbers that are not finite are refused in every condition", "[input]") {
  cdem::Simulation s = simulation(bar());
  cdem::Fix fix;
  fix.displacement = Vec3(0, not_a_number, 0);
  CHECK_THAT(refusal([&] { s.fix(fix); }), Contains("displacement = (0, nan, 0)") && Contains("finite"));
  fix.displacement.reset();
  fix.velocity = Vec3(infinite, 0, 0);
  CHECK_THAT(refusal([&] { s.fix(fix); }), Contains("velocity = (inf, 0, 0)"));
  cdem::Traction traction;
  traction.on = cdem::Selection::side("x+");
  traction.stress = {not_a_number, 0, 0};
  CHECK_THAT(refusal([&] { s.traction(traction); }), Contains("stress = (nan, 0, 0)"));
  cdem::PointForce force;
  force.force = {0, 0, not_a_number};
  CHECK_THAT(refusal([&] { s.force(force); }), Contains("force = (0, 0, nan)"));
  cdem::Gravity gravity;
  gravity.acceleration = {0, 0, infinite};
  CHECK_THAT(refusal([&] { s.gravity(gravity); }), Contains("vector = (0, 0, inf)"));
  gravity.acceleration = {0, 0, -9.81};
  gravity.water_density = -1;
  CHECK_THAT(refusal([&] { s.gravity(gravity); }), Contains("water_density = -1") && Contains(">= 0 kg/m3"));
  CHECK_THAT(refusal([&] {
               s.initial_stress(all(), {0, 0, 0, not_a_number, 0, 0});
             }),
             Contains("stress = nan"));
  CHECK_THAT(refusal([&] {
               s.initial_velocity(all(), {not_a_number, 0, 0});
             }),
             Contains("velocity = (nan, 0, 0)"));
}

TEST_CASE("solving calls refuse what they cannot do", "[input]") {
  cdem::Simulation s = simulation(bar());
  const auto relax = [&](double residual, std::int64_t max_steps) {
    return refusal([&] {
      cdem::RelaxOptions o;
      o.residual = residual;
      o.max_steps = max_steps;
      s.relax(o);
    });
  };
  for (const double bad : {0.0, 1.0, -1.0, not_a_number})
    CHECK_THAT(relax(bad, 10), Contains("residual = ") && Contains("in (0, 1)"));
  CHECK_THAT(relax(1e-6, 0), Contains("max_steps = 0"));

  const auto run = [&](const auto& set) {
    return refusal([&] {
      cdem::RunOptions o;
      o.steps = 1;
      set(o);
      s.run(o);
    });
  };
  CHECK_THAT(run([](auto& o) { o.steps = 0; }), Contains("either duration") && Contains("steps"));
  CHECK_THAT(run([](auto& o) { o.duration = 1; }), Contains("either duration"));
  CHECK_THAT(run([](auto& o) { o.steps = -5; }), Contains("steps"));
  CHECK_THAT(run([](auto& o) { o.duration = not_a_number, o.steps = 0; }), Contains("duration = nan"));
  CHECK_THAT(run([](auto& o) { o.duration = -1, o.steps = 0; }), Contains("duration = -1"));
  for (const double bad : {0.0, 1.1, not_a_number})
    CHECK_THAT(run([=](auto& o) { o.safety = bad; }), Contains("safety = ") && Contains("(0, 1]"));
  for (const double bad : {-1.0, 1.0, not_a_number})
    CHECK_THAT(run([=](auto& o) { o.local_damping = bad; }),
               Contains("local_damping = ") && Contains("[0, 1)"));
  CHECK_THAT(run([](auto& o) { o.time_step = not_a_number; }), Contains("time_step = nan"));
  const double stable = s.stable_time_step();
  CHECK_THAT(run([=](auto& o) { o.time_step = 1.01 * stable; }),
             Contains("time_step = ") && Contains("stable step"));
  CHECK(run([=](auto& o) { o.time_step = 0.99 * stable; }).empty());

  const auto refine = [&](const auto& set) {
    return refusal([&] {
      cdem::RefineOptions o;
      set(o);
      s.refine(o);
    });
  };
  CHECK_THAT(refine([](auto& o) { o.shear_threshold = -1; }), Contains("shear_threshold = -1"));
  CHECK_THAT(refine([](auto& o) { o.tension_threshold = not_a_number; }),
             Contains("tension_threshold = nan"));
  CHECK_THAT(refine([](auto& o) { o.planes = 0; }), Contains("planes = 0") && Contains("1..15"));
  CHECK_THAT(refine([](auto& o) { o.planes = 16; }), Contains("planes = 16"));
  CHECK_THAT(refine([](auto& o) { o.max_depth = 7; }), Contains("max_depth = 7") && Contains("1..6"));
  for (const double bad : {-1.0, not_a_number}) {
    CHECK_THAT(refine([=](auto& o) { o.cohesion = bad; }), Contains("cohesion = "));
    CHECK_THAT(refine([=](auto& o) { o.tensile_strength = bad; }), Contains("tensile_strength = "));
    CHECK_THAT(refine([=](auto& o) { o.friction_angle = bad; }), Contains("friction_angle = "));
  }
  CHECK_THAT(refine([](auto& o) { o.region = nowhere(); }), Contains("holds block centroids"));

  cdem::Simulation weak = simulation(bar(), rock(), cdem::Joint{});
  CHECK_THAT(refusal([&] { weak.refine({}); }), Contains("neither cohesion nor tensile_strength"));
}

TEST_CASE("questions about what is not there are refused", "[input]") {
  cdem::Simulation s = simulation(bar());
  CHECK_THAT(refusal([&] { s.max("displacement.w"); }),
             Contains("\"displacement.w\"") && Contains("displacement.x"));
  CHECK_THAT(refusal([&] { s.mean("stres.xx"); }), Contains("\"stres.xx\"") && Contains("stress.xx"));
  CHECK_THAT(refusal([&] { s.min("stress.xx", nowhere()); }), Contains("holds block centroids"));
  CHECK_THAT(refusal([&] { s.mean("velocity.x", nowhere()); }), Contains("holds nodes"));
  CHECK_THAT(refusal([&] {
               s.at("velocity.x", {9, 9, 9});
             }),
             Contains("at = (9, 9, 9)") && Contains("inside a block"));
  CHECK_THAT(refusal([&] { s.probe("p", "velocity.q", {0.1, 0.05, 0.05}); }), Contains("velocity.q"));
  CHECK_THAT(refusal([&] { s.probe("p", "velocity.x", {9, 9, 9}); }), Contains("inside a block"));
  s.probe("p", "velocity.x", {0.1, 0.05, 0.05});
  CHECK_THAT(refusal([&] {
               s.probe("p", "velocity.x", {0.1, 0.05, 0.05});
             }),
             Contains("name = \"p\"") && Contains("unique"));
  CHECK_THAT(refusal([&] { s.reaction(nowhere()); }), Contains("holds nodes"));
}

TEST_CASE("a pair of a body with itself is refused: its own joint stands with the body", "[input]") {
  cdem::ModelSpec spec;
  spec.bodies = {body("rock", bar())};
  spec.pairs = {{"rock", "rock", rock_joint()}};
  CHECK_THAT(refused(spec), Contains("\"rock\""));
}

TEST_CASE("a joint given twice for the same two bodies is refused", "[input]") {
  cdem::ModelSpec spec;
  spec.bodies = {body("left", bar()), body("right", geom::grid({0.1, 0.1, 0.1}, {1, 1, 1}, {0.2, 0, 0}))};
  spec.pairs = {{"left", "right", rock_joint()}, {"right", "left", cdem::Joint{}}};
  CHECK_THAT(refused(spec), Contains("\"left\"") && Contains("\"right\""));
}
