// Many short runs, each with a condition given again as it was, as a script does that steers a test: they break and lose what
// one run does.
#include "tests/libcdem/cohesive_concrete.hpp"
#include "tests/libcdem/softening_joint.hpp"

#include "libcdem/simulation.hpp"
#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

// Two cubes of 0.1 m whose softening joint is pressed by 4 MPa, and how the moved one is led.
struct PressedJoint {
  cdem::Simulation s{spec(), 1, nullptr};
  cdem::Fix lead = fixed(body_of("moved"));
  cdem::RunOptions options;

  PressedJoint() {
    s.fix(fixed(body_of("still")));
    options.steps = 20;
    lead.displacement = Vec3(-2e-5, 0, 0);
    s.fix(lead);
    s.run(options);
    lead.displacement.reset();
    options.time_step = 0.5 * s.stable_time_step();
  }
  void slide(double way, int steps) { // m; goes on from where the joint stands
    lead.velocity = Vec3(0, way / (steps * options.time_step), 0);
  }

private:
  static cdem::ModelSpec spec() {
    cdem::Joint joint = softening_joint(cdem::Softening::linear);
    joint.normal_stiffness = 2e11;
    joint.shear_stiffness = 1e11;
    cdem::ModelSpec spec;
    spec.bodies = {body("still", geom::grid({0.1, 0.1, 0.1}, {1, 1, 1}, {-0.1, 0, 0}), rock()),
                   body("moved", geom::grid({0.1, 0.1, 0.1}, {1, 1, 1}), rock())};
    spec.pairs = {{"still", "moved", joint}};
    return spec;
  }
};

} // namespace

TEST_CASE("friction and damage of a joint are counted in full where conditions are given again between runs",
          "[run][softening]") {
  const int parts = GENERATE(1, 60, 300); // of 300 steps
  CAPTURE(parts);
  PressedJoint joint;
  joint.options.steps = 300 / parts;
  joint.slide(4e-4, 300);
  for (int i = 0; i < parts; ++i) {
    joint.s.fix(joint.lead);
    joint.s.run(joint.options);
  }
  joint.s.run(joint.options); // one step or more, so that the last of those before is counted
  const cdem::EnergyLedger e = joint.s.energy();
  CHECK(e.breaking == Approx(200 * 0.01).epsilon(1e-3));
  CHECK(e.balance_error() < 2e-3);
}

TEST_CASE("a relaxation counts what the last step of the run before took from springs", "[run][softening]") {
  const auto energy_after = [](bool relaxes) {
    PressedJoint joint;
    joint.options.steps = 10;
    joint.slide(1.2e-4, 10); // its last step is in the middle of softening
    joint.s.fix(joint.lead);
    joint.s.run(joint.options);
    joint.s.fix(fixed(body_of("moved")));
    if (relaxes)
      joint.s.relax({});
    else
      joint.s.run(joint.options);
    return joint.s.energy();
  };
  const cdem::EnergyLedger run = energy_after(false), relaxed = energy_after(true);
  CHECK(run.breaking > 0.1);
  CHECK(relaxed.friction == Approx(run.friction).epsilon(1e-9));
  CHECK(relaxed.breaking == Approx(run.breaking).epsilon(1e-9));
}

TEST_CASE("a brittle face loses its strength within a step of cracking, in whatever parts a run is made",
          "[run][cohesive][breaking]") {
  const bool repeats = GENERATE(false, true);
  CAPTURE(repeats);
  cdem::ModelSpec spec;
  spec.bodies = {concrete_body(unstructured({0.4, 0.1, 0.1}, 0.05), cdem::Softening::none)};
  cdem::Simulation s(spec, 1, nullptr);
  const double speed = 0.2;
  const auto lead = [&] {
    std::vector<cdem::Fix> fixes;
    lead_apart(fixes, speed);
    for (const cdem::Fix& fix : fixes)
      s.fix(fix);
  };
  lead();
  cdem::RunOptions options;
  options.steps = 1;
  options.time_step = 0.2 * s.stable_time_step();
  double peak = 0;
  while (s.time() * speed / 0.4 < 2.5 * tension / concrete().youngs_modulus) {
    if (repeats)
      lead();
    s.run(options);
    peak = std::max(peak, s.mean("stress.xx", cdem::Selection::everything()));
  }
  CHECK(s.counts().broken_tension > 20);
  CHECK(peak < 1.1 * tension);
}
