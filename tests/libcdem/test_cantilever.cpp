// Cantilever in statics: P L^3 / 3 E I + P L / k G A (Timoshenko; k for a rectangle after Cowper 1966).
#include "tests/libcdem/system.hpp"

#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;

namespace {

constexpr double height = 0.8, length = 4 * height, ratio = 0.02;

struct Deflection {
  double measured, exact;
};

Deflection deflection(int blocks_high) {
  const double h = height / blocks_high, shear_stress = 1e5;
  cdem::Joint joint = rock_joint();
  joint.thickness_ratio = ratio;
  cdem::Simulation s =
      simulation(geom::grid({length, height, h}, {4 * blocks_high, blocks_high, 1}), rock(), joint);
  s.fix(fixed(cdem::Selection::side("x-")));
  s.traction(traction(cdem::Selection::side("x+"), {0, shear_stress, 0}));
  cdem::RelaxOptions options;
  options.breaking = false;
  options.residual = 1e-5;
  REQUIRE(s.relax(options).converged);
  const double p = shear_stress * height * h, inertia = h * std::pow(height, 3) / 12, area = height * h;
  const cdem::Elastic m = rock();
  // Joints across x in series with the blocks soften E; those across x and across y both soften G.
  const double young = m.youngs_modulus / (1 + ratio), shear = m.shear_modulus() / (1 + 2 * ratio);
  const double k = 10 * (1 + m.poissons_ratio) / (12 + 11 * m.poissons_ratio);
  return {s.mean("displacement.y", cdem::Selection::side("x+")),
          p * std::pow(length, 3) / (3 * young * inertia) + p * length / (k * shear * area)};
}

} // namespace

TEST_CASE("a cantilever bends by P L^3 / 3 E I + P L / k G A", "[cantilever]") {
  const Deflection coarse = deflection(4), fine = deflection(8);
  INFO(coarse.measured / coarse.exact << " at H/4, " << fine.measured / fine.exact << " at H/8");
  CHECK(fine.measured == Approx(fine.exact).epsilon(0.05));
  // Second order in the block size.
  CHECK((4 * fine.measured - coarse.measured) / 3 == Approx(fine.exact).epsilon(0.02));
}
