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

namespace {

// Flush tiles in a row along x, held, from 0 on, under a block that has come to rest.
struct Tiles {
  static constexpr double gap = 1e-6; // m, under the block at first
  static constexpr int count = 3;     // of 1 m
  System s;
  Tiles(const cdem::Joint& law, const Vec3& size, double start)
      : s([&] {
          std::vector<cdem::BodySpec> bodies;
          std::vector<cdem::PairSpec> pairs;
          for (int i = 0; i < count; ++i)
            bodies.push_back(rigid_block("tile " + std::to_string(i),
                                         geom::grid({1, 3, 0.5}, {1, 1, 1}, {1.0 * i, -1.5, -0.5})));
          bodies.push_back(rigid_block("block", geom::grid(size, {1, 1, 1}, {start, -0.5 * size.y(), gap})));
          for (std::size_t i = 0; i < bodies.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
              pairs.push_back({bodies[j].name, bodies[i].name, law});
          return System(build(bodies, pairs));
        }()) {
    for (int i = 0; i < count; ++i)
      s.hold(body_of(("tile " + std::to_string(i)).c_str()), "xyz");
    s.conditions.gravity = gravity();
    run(0.3, 0.7);
  }
  void run(double duration, double local_damping = 0) {
    cdem::RunOptions options;
    options.duration = duration;
    options.local_damping = local_damping;
    s.run(options);
  }
  Vec3 block() const { return centroid(s, count); }
};

} // namespace

TEST_CASE("a block slides over flush tiles without friction as over one plate, and no deeper",
          "[contact][cover]") {
  const double stiffness = GENERATE(1e7, 1e9), width = GENERATE(0.7, 2.5), speed = GENERATE(1.0, 3.0),
               height = 0.4;
  CAPTURE(stiffness, width, speed);
  cdem::Joint smooth = soft(stiffness);
  smooth.friction_angle = 0;
  Tiles tiles(smooth, {1.3, width, height}, 0.1);
  const auto sinks = [&] { return 0.5 * height + Tiles::gap - tiles.block().z(); };
  const double at_rest = sinks();
  tiles.s.state.rigid[Tiles::count].velocity = cdem::three_of(Vec3(speed, 0, 0));
  tiles.run(1 / speed);
  CHECK(tiles.s.state.rigid[Tiles::count].velocity[0] == Approx(speed).epsilon(1e-3));
  CHECK(sinks() == Approx(at_rest).epsilon(0.1));
  // With the soft contact the block slides a third of what its semi-springs stand in by, in a single step.
  CHECK(std::abs(cdem::energy(tiles.s.model, tiles.s.state).friction) <
        (stiffness > 1e8 ? 1e-5 : 2e-3) * cdem::kinetic_energy(tiles.s.model, tiles.s.state));
}

TEST_CASE("a block slides down a slope of flush tiles as friction says", "[contact][cover]") {
  const double phi = 20, slope = 30, time = 0.7; // degrees, s
  cdem::Joint law = soft(1e9);
  law.friction_angle = phi * degree;
  law.restitution = 0.5; // else it rocks on its leading edge
  Tiles tiles(law, {1.3, 0.7, 0.2}, 0.5);
  tiles.s.conditions.gravity->acceleration =
      9.81 * Vec3(std::sin(slope * degree), 0, -std::cos(slope * degree));
  const double from = tiles.block().x();
  tiles.run(time);
  const double formula =
      9.81 * (std::sin(slope * degree) - std::tan(phi * degree) * std::cos(slope * degree));
  CHECK(2 * (tiles.block().x() - from) / (time * time) == Approx(formula).epsilon(0.01));
}

TEST_CASE("a block that rests half over an edge goes on over it without friction", "[contact][cover]") {
  cdem::Joint smooth = soft(1e9);
  smooth.friction_angle = 0;
  const double speed = 0.5;
  Tiles tiles(smooth, {1, 0.7, 0.4}, 2.3); // 0.3 m of it beyond the last tile
  const Vec3 at_rest = tiles.block();
  CHECK(at_rest.x() == Approx(2.8).epsilon(1e-6));
  tiles.s.state.rigid[Tiles::count].velocity = cdem::three_of(Vec3(speed, 0, 0));
  const double before = cdem::kinetic_energy(tiles.s.model, tiles.s.state);
  tiles.run(0.18 / speed); // not yet half
  CHECK(tiles.block().x() == Approx(2.98).epsilon(1e-4));
  CHECK(tiles.block().z() == Approx(at_rest.z()).margin(1e-4));
  CHECK(cdem::kinetic_energy(tiles.s.model, tiles.s.state) == Approx(before).epsilon(1e-3));
  CHECK(std::abs(cdem::energy(tiles.s.model, tiles.s.state).friction) < 1e-3 * before);
}

TEST_CASE("a block that strikes the walls of a box flat and beside their outlines keeps its energy",
          "[contact][cover]") {
  const double room = 0.05, wide = 1 + room; // m
  cdem::Joint smooth = soft(1e9);
  smooth.friction_angle = 0;
  std::vector<cdem::BodySpec> bodies{
      rigid_block("block", geom::grid({1, 1, 1}, {1, 1, 1}, {0.01, 0.02, 0.03}))};
  std::vector<cdem::PairSpec> pairs;
  for (int axis = 0; axis < 3; ++axis)
    for (const double at : {-1.0, wide}) {
      Vec3 size(wide, wide, wide), corner(0, 0, 0);
      size[axis] = 1;
      corner[axis] = at;
      const std::string name = std::to_string(bodies.size());
      for (const cdem::BodySpec& other : bodies)
        pairs.push_back({other.name, name, smooth});
      bodies.push_back(rigid_block(name, geom::grid(size, {1, 1, 1}, corner)));
    }
  System s(build(bodies, pairs));
  for (std::size_t wall = 1; wall < bodies.size(); ++wall)
    s.hold(body_of(bodies[wall].name.c_str()), "xyz");
  s.state.rigid[0].velocity = cdem::three_of(Vec3(0.47, 0.14, 0.09));
  const double before = cdem::kinetic_energy(s.model, s.state);
  cdem::RunOptions options;
  options.duration = 2;
  s.run(options);
  const cdem::EnergyLedger after = cdem::energy(s.model, s.state);
  CHECK(after.kinetic + after.springs == Approx(before).epsilon(2e-3));
  CHECK(std::abs(after.friction) < 1e-3 * before);
}

TEST_CASE("cubes in layers that slide on each other in a box without friction keep their energy",
          "[contact][cover]") {
  const int count = 3; // along each side
  const double side = 0.2, wide = 0.22, room = count * wide, gap = 1e-6, duration = 0.2;
  cdem::Joint smooth = soft(1e9);
  smooth.friction_angle = 0;
  std::vector<cdem::BodySpec> bodies;
  const auto add = [&](const Vec3& size, const Vec3& origin) {
    bodies.push_back(rigid_block(std::to_string(bodies.size()), geom::grid(size, {1, 1, 1}, origin)));
  };
  add({room, room, 1}, {0, 0, -1});
  for (const double at : {-1.0, room}) {
    add({1, room, 1}, {at, 0, 0});
    add({room, 1, 1}, {0, at, 0});
  }
  const std::size_t walls = bodies.size();
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j)
      for (int k = 0; k < count; ++k)
        add({side, side, side}, {i * wide + 0.01, j * wide + 0.01, gap + k * (side + gap)});
  std::vector<cdem::PairSpec> pairs;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      pairs.push_back({bodies[j].name, bodies[i].name, smooth});
  System s(build(bodies, pairs));
  for (std::size_t wall = 0; wall < walls; ++wall)
    s.hold(body_of(bodies[wall].name.c_str()), "xyz");
  s.conditions.gravity = gravity();
  for (std::size_t b = walls; b < bodies.size(); ++b) { // m/s, up to 0.1, no two alike
    const double x = std::fmod(0.618 * static_cast<double>(b), 1),
                 y = std::fmod(0.414 * static_cast<double>(b), 1);
    s.state.rigid[b].velocity = cdem::three_of(Vec3(0.2 * x - 0.1, 0.2 * y - 0.1, 0));
  }
  const double before = cdem::kinetic_energy(s.model, s.state);
  cdem::RunOptions options;
  options.duration = duration;
  s.run(options);
  const cdem::EnergyLedger after = cdem::energy(s.model, s.state);
  CHECK(std::abs(after.friction) < 1e-3 * before);
  CHECK(after.kinetic + after.springs == Approx(before + after.external).epsilon(1e-3));
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
