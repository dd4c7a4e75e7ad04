// Bars of cubes: stiffness of blocks and joints in series, the first longitudinal mode.
#include "tests/libcdem/columns.hpp"

#include "libgeom/assembly/builders.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

// First natural frequency of a bar fixed at x-, Hz, from the zero crossings of its modal displacement.
// Half blocks at both ends make whole cells of half a block, a joint and half a block: then the effective
// modulus holds up to the ends.
double measured_frequency(const Bar& bar) {
  geom::Assembly shape;
  const double h = bar.h();
  const auto add = [&](double x0, double x1) {
    shape.blocks.push_back(geom::make_box({x0, 0, 0}, {x1, h, h}));
  };
  add(0, h / 2);
  for (int i = 0; i + 1 < bar.blocks; ++i)
    add((i + 0.5) * h, (i + 1.5) * h);
  add(bar.length - h / 2, bar.length);
  cdem::Joint joint = bar.joint();
  joint.thickness = bar.thickness_ratio * h;
  System s(build({body("bar", shape, bar.material(), joint)}));
  s.hold(cdem::Selection::side("x-"), "xyz");
  return axial_frequency(s, bar.length, bar.material());
}

} // namespace

TEST_CASE("a body bonded everywhere is as soft as its blocks and joints in series: E / (1 + L / h)",
          "[bar]") {
  Bar bar;
  bar.blocks = 8;
  bar.thickness_ratio = GENERATE(0.01, 0.02, 0.1, 0.5);
  System s = bar.system();
  s.hold(cdem::Selection::side("x-"), "x");
  s.hold(at_place({0, 0, 0}), "xyz");
  s.hold(at_place({0, bar.h(), 0}), "xz");
  s.conditions.tractions = {traction(cdem::Selection::side("x+"), {1e6, 0, 0})};
  REQUIRE(s.relax(1e-10).converged);
  const std::vector<int> end = nodes_at(s.model, bar.length, 1e-9);
  double stretch = 0;
  for (const int i : end)
    stretch += s.state.displacement[i].x / static_cast<double>(end.size());
  // The outer ends carry no half joint: 8 blocks and 7 joints.
  const double joints = 7 * bar.thickness_ratio * bar.h() / bar.material().youngs_modulus * 1e6;
  CHECK(stretch == Approx(1e6 / bar.material().youngs_modulus * bar.length + joints).epsilon(1e-6));
  const double modulus = 1e6 * bar.length / stretch;
  CHECK(modulus == Approx(bar.effective(bar.material().youngs_modulus)).epsilon(0.05));
}

TEST_CASE(
    "a fixed-free bar vibrates at sqrt(E / rho) / 4 L and the error falls with the square of the block size",
    "[bar]") {
  Bar bar;
  std::vector<double> errors;
  for (const int blocks : {5, 10, 20}) {
    bar.blocks = blocks;
    const double exact =
        std::sqrt(bar.effective(bar.material().youngs_modulus) / bar.material().density) / (4 * bar.length);
    errors.push_back(std::abs(measured_frequency(bar) / exact - 1));
  }
  CAPTURE(errors);
  CHECK(errors[2] < 0.005);
  CHECK(std::log2(errors[0] / errors[1]) >= 1.8);
  CHECK(std::log2(errors[1] / errors[2]) >= 1.8);
}
