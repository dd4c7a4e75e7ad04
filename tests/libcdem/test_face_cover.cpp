// Flat faces of blocks that lie on each other press by the area in which they cover each other.
#include "libcdem/results/contact_points.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

TEST_CASE("a block rests on two bases by the areas that it covers", "[contact][cover]") {
  const bool deforms = GENERATE(false, true);
  const double overlap = GENERATE(0.015, 0.3), wide = GENERATE(1.0, 3.0), gap = 1e-6;
  CAPTURE(deforms, overlap, wide);
  const auto block = [](std::string name, const Vec3& size, const Vec3& origin, bool bends) {
    cdem::BodySpec spec = body(std::move(name), geom::grid(size, {1, 1, 1}, origin));
    spec.element = bends ? cdem::Element::finite_volume : cdem::Element::rigid;
    return spec;
  };
  cdem::Joint law = friction(30);
  law.normal_stiffness = 1e9; // softer than the blocks, so that they press evenly
  System s(build({block("one", {1, wide, 1}, {0, -0.5 * wide, -1}, false),
                  block("two", {1, wide, 1}, {1, -0.5 * wide, -1}, false),
                  block("top", {1, 1, 1}, {overlap, -0.5, gap}, deforms)},
                 {{"one", "top", law}, {"two", "top", law}, {"one", "two", law}}));
  s.hold(body_of("one"), "xyz");
  s.hold(body_of("two"), "xyz");
  s.conditions.gravity = gravity();
  cdem::RunOptions options;
  options.duration = 0.02;
  options.local_damping = 0.5;
  s.run(options);
  std::array<double, 2> on{}; // N
  for (const cdem::ContactPoint& point : cdem::contact_points(s.model, s.state)) {
    const bool top_presses = point.source_body == 2;
    if (top_presses || point.target_body == 2)
      on[top_presses ? point.target_body : point.source_body] += std::abs(point.normal.z());
  }
  REQUIRE(on[0] > 0);
  CHECK(on[1] / (on[0] + on[1]) == Approx(overlap).epsilon(0.02));
}
