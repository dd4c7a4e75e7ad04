// Uniaxial compressive strength of a Mohr-Coulomb material between frictionless plates: 2 c cos(phi) / (1 -
// sin(phi)).
#include "tests/libcdem/system.hpp"

#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;

namespace {

// A column pressed along z, free to widen.
std::vector<cdem::BlockCut> cuts_under(double pressure, double friction_angle) {
  cdem::Joint joint = rock_joint();
  joint.friction_angle = friction_angle;
  cdem::Simulation s = simulation(geom::grid({0.2, 0.2, 0.4}, {2, 2, 4}), rock(), joint);
  s.fix(fixed(cdem::Selection::side("z-"), "z"));
  s.fix(fixed(at_place({0, 0, 0}), "xy"));
  s.fix(fixed(at_place({0.2, 0, 0}), "y"));
  s.traction(traction(cdem::Selection::side("z+"), {0, 0, -pressure}));
  cdem::RelaxOptions options;
  options.residual = 1e-9;
  options.breaking = false;
  REQUIRE(s.relax(options).converged);
  return s.refine({}); // thresholds 0
}

} // namespace

TEST_CASE("between frictionless ends every block fails at 2 c cos phi / (1 - sin phi) and none below it",
          "[failure_plane]") {
  const double phi = GENERATE(0.0, 30.0, 40.0) * degree;
  const double strength = 2 * rock_joint().cohesion * std::cos(phi) / (1 - std::sin(phi));
  CHECK(cuts_under(0.9999 * strength, phi).empty());
  const std::vector<cdem::BlockCut> cuts = cuts_under(1.0001 * strength, phi);
  CHECK(cuts.size() == 16);
  for (const cdem::BlockCut& cut : cuts) {
    CHECK(cut.mode == cdem::CutMode::shear);
    // The plane stands at 45 deg - phi / 2 from the axis of the load.
    CHECK(std::asin(std::abs(cut.normal.z())) == Approx(45 * degree - phi / 2).epsilon(1e-6));
    CHECK(cut.principal.x() == Approx(strength).epsilon(2e-4));
  }
}
