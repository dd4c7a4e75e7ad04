// Viscous damping (Han 2010 eq 1) and Cundall's local damping.
#include "tests/libcdem/columns.hpp"

#include "libcdem/results/energy.hpp"
#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

TEST_CASE("viscous damping slows a free block as v0 exp(-mu t / rho)", "[damping]") {
  cdem::Elastic material = rock();
  material.viscosity = GENERATE(1e4, 1e6);
  System s(build({body("block", geom::grid({0.1, 0.1, 0.1}, {1, 1, 1}), material)}));
  const Vec3 v0(3, -1, 2);
  for (cdem::Node& v : s.state.velocity)
    v = node(v0);
  cdem::RunOptions options;
  options.duration = 2 * material.density / material.viscosity;
  double energy = 1e300;
  bool grew = false;
  options.callback_every = 1;
  options.callback = [&] {
    const double now = cdem::energy(s.model, s.state).kinetic;
    grew = grew || now > energy;
    energy = now;
  };
  const cdem::RunResult run = s.run(options);
  const double factor = std::exp(-material.viscosity * run.time / material.density);
  double error = 0;
  for (const cdem::Node& v : s.state.velocity)
    error = std::max(error, (vec(v) - factor * v0).norm());
  CHECK(error < 0.005 * factor * v0.norm());
  CHECK_FALSE(grew);
  // What is gone stands in the ledger.
  const double mass = material.density * 1e-3;
  CHECK(cdem::energy(s.model, s.state).damping ==
        Approx(0.5 * mass * v0.squaredNorm() * (1 - factor * factor)).epsilon(0.005));
}

TEST_CASE("viscous damping slows the spin of a body as it slows its flight", "[damping]") {
  cdem::Elastic material = rock();
  material.viscosity = 200 * material.density; // both halve in 3.5 ms
  const double zone = GENERATE(0.0, 0.12);
  CAPTURE(zone);
  cdem::BodySpec block = body("block", geom::grid({0.3, 0.2, 0.25}, {1, 1, 1}), material);
  block.element = cdem::Element::finite_volume;
  block.zone_size = zone;
  cdem::ModelSpec spec;
  spec.bodies = {block};
  cdem::Simulation s(spec, 1, nullptr);
  s.initial_velocity(cdem::Selection::everything(), {1, 0, 0}, {0, 0, 2});
  const auto motion = [&] { return s.fragment_motions().front(); };
  const cdem::FragmentMotion before = motion();
  cdem::RunOptions options;
  options.duration = 5e-3;
  s.run(options);
  const cdem::FragmentMotion after = motion();
  CHECK(after.momentum.x() / before.momentum.x() == Approx(std::exp(-1.0)).epsilon(1e-3));
  CHECK(after.angular_momentum.z() / before.angular_momentum.z() == Approx(std::exp(-1.0)).epsilon(2e-3));
}

// A body on a floor with restitution moves by so little that a step may turn the motion of its lightest nodes round: the
// force of restitution must not feed that.
TEST_CASE("deformable blocks that are stacked with restitution come to rest and stay there",
          "[contact][rest]") {
  const double restitution = GENERATE(0.01, 0.3, 0.5), safety = GENERATE(0.5, 0.9);
  CAPTURE(restitution, safety);
  cdem::Elastic soft = rock();
  soft.youngs_modulus = 1e8;
  cdem::ModelSpec spec;
  const auto box = [&](const char* name, const Vec3& size, const Vec3& corner, cdem::Element element) {
    cdem::BodySpec block = body(name, geom::grid(size, {1, 1, 1}, corner), soft);
    block.element = element;
    return block;
  };
  constexpr double gap = 1e-5;
  spec.bodies = {box("floor", {3, 3, 0.5}, {-1.4, -1.5, -0.5}, cdem::Element::rigid),
                 box("lower", {0.6, 0.5, 0.4}, {-0.3, -0.3, gap}, cdem::Element::finite_volume),
                 box("upper", {0.6, 0.6, 0.3}, {-0.3, -0.3, 0.4 + 2 * gap}, cdem::Element::finite_volume)};
  cdem::Joint law;
  law.bonded = false;
  law.friction_angle = 30 * degree;
  law.restitution = restitution;
  spec.default_contact = law;
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::of_body("floor")));
  s.gravity(gravity());
  cdem::RunOptions settling;
  settling.duration = 0.3;
  settling.local_damping = 0.5;
  s.run(settling);
  cdem::RunOptions rest;
  rest.duration = 0.3;
  rest.safety = safety;
  s.run(rest);
  CHECK(s.energy().kinetic < 1e-18);
  CHECK(s.energy().balance_error() < 1e-3);
}

TEST_CASE("local damping takes a suddenly loaded bar to its static stretch", "[damping]") {
  Bar bar;
  bar.blocks = 5;
  System s = bar.system();
  s.hold(cdem::Selection::side("x-"), "xyz");
  s.conditions.tractions = {traction(cdem::Selection::side("x+"), {1e6, 0, 0})};
  cdem::RunOptions options;
  options.local_damping = 0.7;
  options.duration = 20 * 4 * bar.length / std::sqrt(bar.material().youngs_modulus / bar.material().density);
  s.run(options);
  const double stretch =
      1e6 / bar.material().youngs_modulus * (bar.length + 4 * bar.thickness_ratio * bar.h());
  double error = 0;
  for (const int i : nodes_at(s.model, bar.length, 1e-9))
    error = std::max(error, std::abs(s.state.displacement[i].x - stretch));
  CHECK(error < 1e-3 * stretch);
  CHECK(s.log.breaks.empty()); // no peak above the 5 MPa that the bonds carry
  CHECK(cdem::energy(s.model, s.state).damping > 0);
}
