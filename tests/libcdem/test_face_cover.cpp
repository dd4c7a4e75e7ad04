// Flat faces of blocks that lie on each other press by the area in which they cover each other.
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/results/contact_points.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/assembly/builders.hpp"
#include "tests/libcdem/boxes.hpp"

#include <catch2/catch.hpp>

using namespace testing;
using geom::Vec3;

namespace {

cdem::BodySpec rigid_block(std::string name, geom::Assembly shape) {
  cdem::BodySpec spec = body(std::move(name), std::move(shape));
  spec.element = cdem::Element::rigid;
  return spec;
}

cdem::Joint soft(double stiffness) { // Pa/m
  cdem::Joint law = friction(30);
  law.normal_stiffness = law.shear_stiffness = stiffness;
  return law;
}

} // namespace

TEST_CASE("a block that falls flat on another rebounds in full, flush or not, however deep",
          "[contact][cover]") {
  const double side = GENERATE(1.0, 3.0), part = GENERATE(0.001, 0.004, 0.01),
               speed = 1; // part: of the height, deepest
  CAPTURE(side, part);
  const double stiffness = rock().density * std::pow(speed / part, 2); // of a mass on a spring
  System s(build({rigid_block("base", geom::grid({side, side, 1}, {1, 1, 1}, {-0.5 * side, -0.5 * side, -1})),
                  rigid_block("top", geom::grid({1, 1, 1}, {1, 1, 1}, {-0.5, -0.5, 1e-4}))},
                 {{"base", "top", soft(stiffness)}}));
  s.hold(body_of("base"), "xyz");
  s.state.rigid[1].velocity = cdem::three_of(Vec3(0, 0, -speed));
  cdem::RunOptions options;
  options.duration = 2e-4 / speed + 1.5 * pi * part / speed;
  s.run(options);
  CHECK(s.log.deepest_contact == Approx(part).epsilon(0.01));
  CHECK(s.state.rigid[1].velocity[2] == Approx(speed).epsilon(1e-3));
}

TEST_CASE("a block sinks as the pressure on the area that it covers says, at any depth", "[contact][cover]") {
  const double side = GENERATE(1.0, 5.0), part = GENERATE(0.002, 0.006, 0.01);
  CAPTURE(side, part);
  const double stiffness = rock().density * 9.81 / part;
  System s(build({rigid_block("base", geom::grid({side, side, 1}, {1, 1, 1}, {-0.5 * side, -0.5 * side, -1})),
                  rigid_block("top", geom::grid({1, 1, 1}, {1, 1, 1}, {-0.5, -0.5, 1e-6}))},
                 {{"base", "top", soft(stiffness)}}));
  s.hold(body_of("base"), "xyz");
  s.conditions.gravity = gravity();
  cdem::RunOptions options;
  options.duration = 1;
  options.local_damping = 0.8;
  s.run(options);
  CHECK(centroid(s, 1).z() == Approx(0.5 - part).epsilon(1e-5));
}

TEST_CASE("a block whose tip reaches over the next base rests as if the tip were not there",
          "[contact][cover]") {
  const double angle = GENERATE(5.0, 12.0, 15.0, 20.0, 25.0), reach = GENERATE(0.0005, 0.002, 0.004);
  CAPTURE(angle, reach);
  geom::Assembly turned = geom::grid({1, 1, 0.4}, {1, 1, 1}, {0, 0, 1e-6});
  const geom::Mat3 by = rotation({0, 0, 1}, angle * degree);
  for (geom::Vec3& x : turned.blocks[0].vertices)
    x = by * x + Vec3(0.1234, -reach, 0);
  System s(build({rigid_block("top", turned),
                  rigid_block("near", geom::grid({6, 3, 0.5}, {1, 1, 1}, {-3, -3, -0.5})),
                  rigid_block("under", geom::grid({6, 4, 0.5}, {1, 1, 1}, {-3, 0.02, -0.5}))},
                 {{"near", "top", soft(1e9)}, {"under", "top", soft(1e9)}, {"near", "under", soft(1e9)}}));
  s.hold(body_of("near"), "xyz");
  s.hold(body_of("under"), "xyz");
  s.conditions.gravity = gravity();
  cdem::RunOptions options;
  options.duration = 0.05;
  options.local_damping = 0.6;
  s.run(options);
  CHECK(s.state.step < 2000); // the contact at the tip shortens no step
  CHECK(cdem::energy(s.model, s.state).kinetic < 1e-9);
  CHECK(cdem::energy(s.model, s.state).balance_error() < 1e-3);
}

TEST_CASE("a bar that turns on a smaller base without friction goes on turning, and sinks no further",
          "[contact][cover]") {
  const double gap = 1e-6, spin = 2 * pi; // m, rad/s
  cdem::Joint smooth = soft(1e9);
  smooth.friction_angle = 0;
  System s(build({rigid_block("base", geom::grid({0.6, 0.5, 0.4}, {1, 1, 1}, {-0.3, -0.25, -0.4})),
                  rigid_block("bar", geom::grid({1.2, 0.3, 0.3}, {1, 1, 1}, {-0.6, -0.15, gap}))},
                 {{"base", "bar", smooth}}));
  s.hold(body_of("base"), "xyz");
  s.conditions.gravity = gravity();
  cdem::RunOptions options;
  options.duration = 0.1;
  options.local_damping = 0.7;
  s.run(options);
  const double at_rest = 0.15 - centroid(s, 1).z();
  REQUIRE(at_rest > 0);
  const double inertia = rock().density * 1.2 * 0.3 * 0.3 * (1.2 * 1.2 + 0.3 * 0.3) / 12;
  s.state.rigid[1].angular_momentum = cdem::three_of(Vec3(0, 0, inertia * spin));
  options.duration = 1; // a turn
  options.local_damping = 0;
  for (int turn = 0; turn < 3; ++turn) {
    s.run(options);
    CHECK(0.15 - centroid(s, 1).z() < 2 * at_rest); // it hops
  }
  CHECK(cdem::kinetic_energy(s.model, s.state) == Approx(0.5 * inertia * spin * spin).epsilon(1e-3));
}

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
