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
