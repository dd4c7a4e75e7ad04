// Which units have left their place, and in which order.
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/procedure/turn_rigid.hpp"
#include "libcdem/results/watch.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"
#include "tests/libcdem/system.hpp"
#include "tests/libcdem/two_halves.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace testing;
using geom::Vec3;

namespace {

// `count` cubes of 1 m, 1 m apart along x, as units of one body, on a slab.
System cubes(int count) {
  cdem::BodySpec slab = meshed("slab", geom::box_mesh({2.0 * count, 1, 1}, {1, 1, 1}));
  cdem::BodySpec units = meshed("units", geom::box_mesh({1, 1, 1}, {1, 1, 1}));
  const geom::TetMesh mesh = units.meshes[0];
  units.meshes.clear();
  for (int i = 0; i < count; ++i) {
    units.meshes.push_back(mesh);
    for (Vec3& x : units.meshes.back().nodes)
      x += Vec3(2.0 * i, 0, 2);
  }
  slab.element = units.element = cdem::Element::rigid;
  System s(build({slab, units}));
  return s;
}

// Gives contacts something to name: one triangle a block.
void add_surface(System& s) {
  s.model.surface.triangles.clear();
  for (int b = 0; b < static_cast<int>(s.model.blocks.size()); ++b) {
    cdem::ContactTriangle triangle;
    triangle.block = b;
    s.model.surface.triangles.push_back(triangle);
  }
}

void touch(System& s, int block_a, int block_b, cdem::Contact::Kind kind = cdem::Contact::spring) {
  cdem::Contact contact(kind, 3 * block_a + 1);
  contact.target = kind == cdem::Contact::spring ? block_b : 3 * block_b + 2;
  s.state.contacts.push_back(contact);
}

void move(System& s, int block, const Vec3& way) {
  for (int i = s.model.blocks[block].node_begin; i < s.model.blocks[block].node_end; ++i)
    s.state.displacement[i] = node(vec(s.state.displacement[i]) + way);
}

std::vector<int> units_left(const cdem::Watch& watch) {
  std::vector<int> units;
  for (const cdem::Departure& d : watch.left)
    units.push_back(d.unit);
  return units;
}

} // namespace

TEST_CASE("units leave in the order and at the time their motion takes them from the ground", "[watch]") {
  System s = cubes(4);
  s.hold(cdem::Selection::of_body("slab"), "xyz");
  const double speed[] = {1, 4, 0, 2}; // m/s
  for (int unit = 0; unit < 4; ++unit)
    s.state.rigid[unit + 1].velocity = {0, -speed[unit], 0};
  s.log.watches.push_back(cdem::start_watch(s.model, s.state, "units", 0.5));
  cdem::Flow flow;
  flow.direction = {1, 0, 0};
  flow.water_density = 1e-9; // no push to speak of
  flow.velocity = [](double time) { return 10 * time; };
  const bool flows = GENERATE(false, true);
  if (flows)
    s.conditions.flows.push_back(flow);
  cdem::RunOptions options;
  options.time_step = 1e-3;
  options.steps = 600;
  s.run(options);
  const cdem::Watch& watch = s.log.watches[0];
  CHECK(units_left(watch) == std::vector<int>{2, 4, 1});
  for (const cdem::Departure& d : watch.left) {
    INFO("unit " << d.unit);
    const double v = speed[d.unit - 1];
    CHECK(d.time >= 0.5 / v - 1e-9);
    CHECK(d.time <= 0.5 / v + 0.05 + 1e-9); // 50 steps between looks
    CHECK((d.displacement - Vec3(0, -v * d.time, 0)).norm() < 1e-9);
    CHECK((d.place - Vec3(2.0 * (d.unit - 1) + 0.5, 0.5 - v * d.time, 2.5)).norm() < 1e-9);
    if (flows)
      CHECK(d.velocity == Approx(10 * d.time).epsilon(1e-12));
    else
      CHECK(std::isnan(d.velocity));
  }
}

TEST_CASE("what moves with all it touches has not left", "[watch]") {
  System s = cubes(3); // block 0 is the slab, units 1..3 are blocks 1..3
  add_surface(s);
  touch(s, 1, 0);
  touch(s, 2, 0, cdem::Contact::edge);
  touch(s, 2, 1);
  touch(s, 2, 1); // touching twice counts once
  cdem::Watch watch = cdem::start_watch(s.model, s.state, "units", 0.5);
  for (int block = 0; block < 3; ++block)
    move(s, block, {0, 0, -3});
  cdem::look(s.model, s.state, 1, watch);
  CHECK(watch.left.empty());
  // Unit 1 is measured against the mean of slab and unit 2, unit 2 against that of slab and unit 1.
  move(s, 2, {0.49, 0, 0});
  cdem::look(s.model, s.state, 2, watch);
  CHECK(watch.left.empty());
  move(s, 2, {0.02, 0, 0});
  cdem::look(s.model, s.state, 3, watch);
  CHECK(units_left(watch) == std::vector<int>{2});
  CHECK((watch.left[0].displacement - Vec3(0.51, 0, 0)).norm() < 1e-12);
  CHECK(watch.left[0].velocity == 3);
  // What has left counts no more: unit 1 stays where the slab is, however far unit 2 goes.
  move(s, 2, {20, 0, 0});
  cdem::look(s.model, s.state, 4, watch);
  CHECK(watch.left.size() == 1);
  // Unit 3 touched nothing: the ground.
  move(s, 3, {0, 0.6, 0});
  cdem::look(s.model, s.state, 5, watch);
  CHECK(units_left(watch) == std::vector<int>{2, 3});
}

TEST_CASE("a watch that has nothing to look at is refused", "[watch][input]") {
  System s = cubes(1);
  CHECK_THROWS_WITH(cdem::start_watch(s.model, s.state, "stones", 0.5),
                    Catch::Contains("body = \"stones\"") && Catch::Contains("\"slab\", \"units\""));
  CHECK_THROWS_WITH(cdem::start_watch(s.model, s.state, "units", 0), Catch::Contains("leaves = 0"));
}

TEST_CASE("a watch goes on from a saved model, and can be taken back to a step that has passed",
          "[watch][checkpoint]") {
  const auto build_units = [] {
    cdem::BodySpec units = meshed("units", geom::box_mesh({1, 1, 1}, {1, 1, 1}));
    units.element = cdem::Element::rigid;
    units.meshes.push_back(units.meshes[0]);
    for (Vec3& x : units.meshes[1].nodes)
      x += Vec3(3, 0, 0);
    cdem::ModelSpec spec;
    spec.bodies = {units};
    return cdem::Simulation(spec, 1, nullptr);
  };
  cdem::RunOptions options;
  options.time_step = 1e-3;
  options.steps = 300;
  cdem::Simulation whole = build_units();
  const auto right = cdem::Selection::where([](const Vec3& x) { return x.x() > 2; }, "the right one");
  whole.initial_velocity(cdem::Selection::everything(), {0, 2, 0});
  whole.initial_velocity(right, {0, 1, 0});
  REQUIRE(whole.watch("units", 0.5) == 0);
  whole.run(options);
  REQUIRE(whole.log().watches.at(0).left.size() == 1);
  const std::string saved = whole.save();
  whole.run(options);
  REQUIRE(whole.log().watches.at(0).left.size() == 2);
  const bool watched_first = GENERATE(true, false);
  cdem::Simulation next = build_units();
  if (watched_first)
    next.watch("units", 0.5);
  next.restore(saved);
  if (!watched_first)
    CHECK(next.watch("units", 0.5) == 0);
  CHECK(next.log().watches.at(0).left.size() == 1);
  next.run(options);
  REQUIRE(next.log().watches.at(0).left.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(next.log().watches.at(0).left[i].unit == static_cast<int>(i) + 1);
    CHECK(next.log().watches.at(0).left[i].step == whole.log().watches.at(0).left[i].step);
    CHECK(next.log().watches.at(0).left[i].displacement == whole.log().watches.at(0).left[i].displacement);
  }
  cdem::Watch watch;
  watch.blocks = {4, 7};
  watch.numbers = {1, 2};
  watch.gone.assign(8, 1);
  watch.left = whole.log().watches.at(0).left;
  const cdem::Watch then = cdem::watch_at(watch, whole.log().watches.at(0).left[0].step);
  CHECK(units_left(then) == std::vector<int>{1});
  CHECK((then.gone[4] == 1 && then.gone[7] == 0));
}

TEST_CASE("a unit that stands still while its neighbours go has not left", "[watch]") {
  System s = cubes(3);
  add_surface(s);
  touch(s, 1, 2);
  touch(s, 2, 3);
  cdem::Watch watch = cdem::start_watch(s.model, s.state, "units", 0.5);
  move(s, 1, {0, 0.45, 0}); // 0.9 apart from the middle one's point of view
  move(s, 3, {0, 0.45, 0});
  move(s, 2, {0, -0.45, 0});
  cdem::look(s.model, s.state, 0, watch);
  CHECK(watch.left.empty());
  move(s, 2, {0, -0.1, 0}); // now it has moved itself
  cdem::look(s.model, s.state, 0, watch);
  CHECK(units_left(watch) == std::vector<int>{2});
}

TEST_CASE("a piece of a unit that breaks leaves, the rest stays", "[watch][cohesive]") {
  cdem::Bonding bonding = cohesive();
  bonding.everywhere = false;
  bonding.between_regions = true;
  System s(
      build({meshed("units", two_halves(2), bonding, concrete(), concrete_joint(cdem::Softening::linear))}));
  const double speed = 5, leaves = 0.02;
  for (const char* end : {"z-", "z+"}) {
    cdem::Fix fix = fixed(cdem::Selection::side(end), "xyz");
    fix.velocity = {0, 0, end[1] == '+' ? speed : 0};
    s.conditions.fixes.push_back(fix);
  }
  s.log.watches.push_back(cdem::start_watch(s.model, s.state, "units", leaves));
  cdem::RunOptions options;
  options.duration = 2 * leaves / speed;
  s.run(options);
  const cdem::Watch& watch = s.log.watches[0];
  REQUIRE(watch.left.size() == 1);
  const cdem::Departure& piece = watch.left[0];
  CHECK(piece.unit == 1);
  CHECK(piece.share == Approx(0.5).epsilon(1e-6));
  CHECK(piece.displacement.z() >= leaves);
  CHECK(piece.displacement.z() < 1.2 * leaves);
  CHECK(piece.place.z() == Approx(0.75 * side + piece.displacement.z()).epsilon(1e-6));
  CHECK(watch.gone[watch.blocks[0]] == 0);
  const cdem::Watch before = cdem::watch_at(watch, piece.step - 1);
  CHECK(before.left.empty());
  CHECK(std::count(before.tet_left.begin(), before.tet_left.end(), -1) ==
        static_cast<std::ptrdiff_t>(before.tet_left.size()));
}
