// Loads and supports: what arrives at the nodes, and what comes back at the supports.
#include "libcdem/bond/release.hpp"
#include "tests/libcdem/boxes.hpp"
#include "tests/libcdem/columns.hpp"
#include "tests/libcdem/going_on.hpp"

#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/polyhedron/cut.hpp"

#include <catch2/catch.hpp>

#include <chrono>

using namespace testing;
using geom::Vec3;

namespace {

struct Resultant {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
};

Resultant resultant(const System& s, double time = 0) {
  cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
  cdem::update_external(r, time);
  Resultant sum;
  for (std::size_t i = 0; i < r.external.size(); ++i) {
    sum.force += vec(r.external[i]);
    sum.moment += s.model.node_position[i].cross(vec(r.external[i]));
  }
  return sum;
}

} // namespace

TEST_CASE("a traction on partly covered faces is stress times uncovered area, at its centroid", "[loads]") {
  // A small block stands on a corner of a large one.
  cdem::Joint joint = rock_joint();
  System s(build({body("large", geom::grid({1, 1, 0.5}, {1, 1, 1})),
                  body("small", geom::grid({0.4, 0.3, 0.2}, {1, 1, 1}, {0, 0, 0.5}))},
                 {{"large", "small", joint}}));
  const Vec3 stress(3e5, -2e5, -1e6);
  s.conditions.tractions = {
      traction(cdem::Selection::on_plane(geom::Plane::through({0, 0, 0.5}, {0, 0, 1})), stress)};
  // Both faces in the plane: of the large block all but 0.4 x 0.3, of the small one nothing.
  const double area = 1 - 0.12;
  const Vec3 centroid = (Vec3(0.5, 0.5, 0.5) - 0.12 * Vec3(0.2, 0.15, 0.5)) / area;
  const Resultant sum = resultant(s);
  CHECK((sum.force - area * stress).norm() < 1e-10 * stress.norm());
  CHECK((sum.moment - area * centroid.cross(stress)).norm() < 1e-10 * stress.norm());
}

TEST_CASE("a point force is shared among the nodes and sums to itself, at any time of its amplitude",
          "[loads]") {
  System s(build({body("rock", geom::grid({1, 1, 1}, {2, 2, 1}))}));
  cdem::PointForce force;
  force.on = cdem::Selection::on_plane(geom::Plane::through({0, 0.5, 0}, {0, 1, 0}));
  force.force = {10, -20, 30};
  s.conditions.forces = {force};
  CHECK((resultant(s).force - force.force).norm() < 1e-12);
  force.amplitude = [](double t) { return 0.5 * t; };
  s.conditions.forces.push_back(force);
  CHECK((resultant(s, 3).force - 2.5 * force.force).norm() < 1e-12);
}

TEST_CASE("a pressure all round has no resultant", "[loads]") {
  geom::VoronoiOptions cells;
  cells.count = 15;
  System s(build({body("rock", geom::voronoi(cells))}));
  s.load_all_faces(-1e6 * geom::Mat3::Identity());
  CHECK(resultant(s).force.norm() < 1e-10 * 1e6);
  CHECK(resultant(s).moment.norm() < 1e-10 * 1e6);
}

TEST_CASE("a pressure does not act on faces between blocks that have parted", "[loads]") {
  cdem::BodySpec rock = body("rock", geom::grid({2, 1, 1}, {2, 1, 1}));
  rock.element = cdem::Element::finite_volume;
  System s(build({rock}));
  s.load_all_faces(-1e6 * geom::Mat3::Identity());
  std::fill(s.state.bond_mode.begin(), s.state.bond_mode.end(),
            static_cast<std::uint8_t>(cdem::BondMode::broken_tension));
  const cdem::Block& right = s.model.blocks[1];
  for (int node = right.node_begin; node < right.node_end; ++node)
    s.state.displacement[node].x = 0.5;
  REQUIRE(release_interfaces(s.model, s.state, 1).interfaces == 1);
  CHECK(resultant(s).force.norm() < 1e-6);
  cdem::ResolvedConditions resolved = cdem::resolve(s.model, s.state, s.conditions);
  cdem::update_external(resolved, 0);
  Vec3 on_right = Vec3::Zero();
  for (int node = right.node_begin; node < right.node_end; ++node)
    on_right += vec(resolved.external[node]);
  CHECK((on_right - Vec3(-1e6, 0, 0)).norm() < 1e-6); // its outer end alone, 1 m2
}

namespace {

cdem::Traction water_to(double level, double weight = 9810) {
  cdem::Traction water;
  water.on = cdem::Selection::everything();
  water.pressure = cdem::FacePressure{level, weight, {}};
  return water;
}

// Blocks whose faces cross the water at all angles: a turned box in Voronoi cells.
geom::Assembly turned_rock() {
  geom::VoronoiOptions cells;
  cells.size = {1, 0.8, 0.6};
  cells.count = 12;
  return geom::rotated(geom::voronoi(cells), {1, 2, 3}, 0.8, {0.5, 0.4, 0.3});
}

} // namespace

TEST_CASE("a submerged body is lifted by the weight of the water, at its centroid", "[loads][reservoir]") {
  const double weight = 9810, level = 5;
  const geom::Assembly blocks = turned_rock();
  const auto element = GENERATE(cdem::Element::small_strain, cdem::Element::finite_volume);
  cdem::BodySpec spec = body("rock", blocks);
  spec.element = element;
  spec.zone_size = element == cdem::Element::finite_volume ? 0.3 : 0;
  System s(build({spec}));
  s.conditions.tractions = {water_to(level, weight)};
  const Resultant sum = resultant(s);
  double volume = 0;
  Vec3 moment = Vec3::Zero();
  for (const geom::Polyhedron& block : blocks.blocks) {
    const geom::MassProperties mass = geom::mass_properties(block);
    volume += mass.volume;
    moment += mass.volume * mass.centroid;
  }
  CHECK((sum.force - Vec3(0, 0, weight * volume)).norm() < 1e-9 * weight * level);
  CHECK((sum.moment - moment.cross(Vec3(0, 0, weight))).norm() < 1e-9 * weight * level);
}

TEST_CASE("a body that floats is lifted by the water that its part below the level displaces",
          "[loads][reservoir]") {
  const double weight = 9810, level = 0.33;
  const geom::Assembly blocks = turned_rock();
  double below = 0;
  for (const geom::Polyhedron& block : blocks.blocks)
    if (const auto part = geom::cut(block, geom::Plane::through({0, 0, level}, {0, 0, 1})).below)
      below += geom::mass_properties(part->shape).volume;
  System s(build({body("rock", blocks)}));
  s.conditions.tractions = {water_to(level, weight)};
  CHECK((resultant(s).force - Vec3(0, 0, weight * below)).norm() < 1e-9 * weight);
  // The same pressure as a function of the place: to the size of the parts that it is taken at.
  s.conditions.tractions[0].pressure =
      cdem::FacePressure{{}, 1, [&](const Vec3& x) { return std::max(0.0, weight * (level - x.z())); }};
  CHECK((resultant(s).force - Vec3(0, 0, weight * below)).norm() < 0.01 * weight * below);
}

TEST_CASE("a reservoir pushes an inclined face with gamma h^2 / 2 per width, at a third of its depth",
          "[loads][reservoir]") {
  // A dam 3 m wide, 10 m high, whose upstream face leans by 60 degrees; water 7 m deep.
  const double width = 3, height = 10, deep = 7, lean = height / std::tan(60 * degree), weight = 9810;
  std::vector<Vec3> corners;
  for (const double y : {0.0, width})
    for (const Vec3& x : {Vec3(0, y, 0), Vec3(20, y, 0), Vec3(20, y, height), Vec3(lean, y, height)})
      corners.push_back(x);
  geom::Assembly dam;
  dam.blocks = {geom::convex_hull(corners)};
  System s(build({body("dam", dam)}));
  cdem::Traction water = water_to(deep, weight);
  water.on = cdem::Selection::on_plane(geom::Plane::through({0, 0, 0}, {-height, 0, lean}));
  s.conditions.tractions = {water};
  const Resultant sum = resultant(s);
  CHECK(sum.force.x() == Approx(weight * deep * deep / 2 * width));
  CHECK(sum.force.z() == Approx(-sum.force.x() * lean / height));
  const Vec3 at(lean * deep / 3 / height, width / 2, deep / 3);
  CHECK((sum.moment - at.cross(sum.force)).norm() < 1e-9 * sum.moment.norm());
  s.conditions.tractions[0].pressure->level = -1;
  CHECK_THROWS_WITH(resultant(s), Catch::Matchers::Contains("none of them is under water"));
}

TEST_CASE("the same pressure everywhere is the traction along the normals, on blocks and on meshes",
          "[loads][reservoir]") {
  cdem::Traction even;
  even.on = cdem::Selection::everything();
  even.pressure = cdem::FacePressure{{}, 1, [](const Vec3&) { return 2e5; }};
  for (const bool mesh : {false, true}) {
    const geom::Assembly blocks = geom::grid({1, 1, 1}, {2, 2, 2});
    System s(build({mesh ? meshed("rock", geom::box_mesh({1, 1, 1}, {2, 2, 2})) : body("rock", blocks)}));
    even.on = cdem::Selection::side("x+");
    s.conditions.tractions = {even};
    CHECK((resultant(s).force - Vec3(-2e5, 0, 0)).norm() < 1e-6);
  }
}

TEST_CASE("a column under its own weight carries rho g times the height above", "[loads]") {
  cdem::Simulation s = simulation(geom::grid({0.1, 0.1, 1}, {1, 1, 10}));
  s.fix(fixed(cdem::Selection::side("z-"), "z"));
  s.fix(fixed(at_place({0, 0, 0}), "xy"));
  s.fix(fixed(at_place({0.1, 0, 0}), "y"));
  cdem::Gravity gravity;
  gravity.acceleration = {0, 0, -9.81};
  gravity.water_density = GENERATE(0.0, 1000.0);
  s.gravity(gravity);
  cdem::RelaxOptions options;
  options.residual = 1e-9;
  REQUIRE(s.relax(options).converged);
  const double weight = (rock().density - gravity.water_density) * 9.81; // N/m3, buoyant under water
  for (const auto& row : s.blocks())
    CHECK(row.stress[2] == Approx(-weight * (1 - row.centroid.z())).epsilon(1e-6));
  CHECK(s.reaction(cdem::Selection::side("z-")).z() == Approx(weight * 0.01).epsilon(1e-7));
}

TEST_CASE("water takes from the weight, never from the inertia", "[loads]") {
  cdem::Simulation s = simulation(geom::grid({0.1, 0.1, 0.1}, {1, 1, 1}));
  cdem::Gravity gravity;
  gravity.acceleration = {0, 0, -9.81};
  gravity.water_density = 1000;
  s.gravity(gravity);
  cdem::RunOptions options;
  options.duration = 1e-3;
  const cdem::RunResult run = s.run(options);
  // Velocities stand half a step before the time of the displacements.
  const double expected = -9.81 * (1 - 1000 / rock().density) * (run.time - 0.5 * run.time_step);
  CHECK(s.min("velocity.z").value == Approx(expected).epsilon(1e-9));
  CHECK(s.max("velocity.z").value == Approx(expected).epsilon(1e-9));
}

TEST_CASE("a given displacement of a bar's end takes E A u over L with blocks and joints in series",
          "[loads]") {
  Bar bar;
  bar.blocks = 6;
  bar.poissons_ratio = 0.25;
  cdem::Simulation s = simulation(bar.shape(), bar.material(), bar.joint());
  s.fix(fixed(cdem::Selection::side("x-"), "x"));
  cdem::Fix pull = fixed(cdem::Selection::side("x+"), "x");
  pull.displacement = Vec3(1e-5, 0, 0);
  s.fix(pull);
  s.fix(fixed(at_place({0, 0, 0}), "yz"));
  s.fix(fixed(at_place({0, bar.h(), 0}), "z"));
  cdem::RelaxOptions options;
  options.breaking = false;
  options.residual = 1e-9;
  REQUIRE(s.relax(options).converged);
  const double young = bar.material().youngs_modulus;
  const double force = 1e-5 * bar.area() * young / (bar.length + 5 * bar.thickness_ratio * bar.h());
  CHECK(s.reaction(cdem::Selection::side("x+")).x() == Approx(force).epsilon(1e-7));
  CHECK(s.reaction(cdem::Selection::side("x-")).x() == Approx(-force).epsilon(1e-7));
  CHECK(s.mean("displacement.x", cdem::Selection::side("x+")) == Approx(1e-5).epsilon(1e-12));
}

TEST_CASE(
    "a bar pulled near its strength by its end carries E strain A, whatever its length and the increments",
    "[loads][relax]") {
  const double tension = 3e6, side = 0.2;
  cdem::Joint joint = rock_joint();
  joint.tensile_strength = tension;
  joint.cohesion = 3 * tension;
  const bool is_mesh = GENERATE(false, true);
  if (!is_mesh)
    joint.normal_stiffness = joint.shear_stiffness = 1e13;
  const int n = GENERATE(20, 60);
  const auto [part, increments] = GENERATE(std::pair{0.3, 1}, std::pair{0.9, 1}, std::pair{0.9, 3});
  CAPTURE(is_mesh, n, part, increments);
  const double length = 0.1 * n;
  cdem::ModelSpec spec;
  cdem::Bonding all;
  all.kind = cdem::BondKind::cohesive;
  all.everywhere = true;
  if (is_mesh)
    spec.bodies = {meshed("bar", geom::box_mesh({length, side, side}, {n, 2, 2}), all, rock(), joint)};
  else
    spec.bodies = {body("bar", geom::grid({length, side, side}, {n, 1, 1}), rock(), joint)};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("x-"), "x"));
  s.fix(fixed(at_place({0, 0, 0}), "yz"));
  s.fix(fixed(at_place({0, side, 0}), "z"));
  cdem::RelaxOptions options;
  options.residual = 1e-5;
  const double compliance =
      length / rock().youngs_modulus + (is_mesh ? 0 : (n - 1) / *joint.normal_stiffness); // m/Pa
  for (int i = 1; i <= increments; ++i) {
    cdem::Fix pull = fixed(cdem::Selection::side("x+"), "x");
    pull.displacement = Vec3(part * tension * compliance * i / increments, 0, 0);
    s.fix(pull);
    REQUIRE(s.relax(options).converged);
  }
  CHECK(s.counts().broken_tension + s.counts().broken_shear == 0);
  CHECK(s.reaction(cdem::Selection::side("x+")).x() == Approx(part * tension * side * side).epsilon(1e-3));
}

TEST_CASE("a moved base carries the block on it, and a block that is pushed slides at its friction",
          "[loads][relax]") {
  cdem::ModelSpec spec;
  spec.bodies = {meshed("base", box_at({1.2, 1, 0.4}, {6, 5, 2}, geom::Mat3::Identity(), {0.5, 0.5, -0.2})),
                 meshed("block", box_at({1, 1, 0.4}, {5, 5, 2}, geom::Mat3::Identity(), {0.5, 0.5, 0.2}))};
  spec.pairs = {{"base", "block", friction(30)}};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(body_of("base")));
  s.gravity(gravity({0, 0, -9.81}));
  cdem::RelaxOptions options;
  options.residual = 1e-5;
  REQUIRE(s.relax(options).converged);
  const double weight = rock().density * 9.81 * 0.4;
  SECTION("carried") {
    cdem::Fix base = fixed(body_of("base"));
    base.displacement = Vec3(5e-3, 0, 0);
    s.fix(base);
    REQUIRE(s.relax(options).converged);
    CHECK(s.mean("displacement.x", body_of("block")) == Approx(5e-3).epsilon(1e-3));
  }
  SECTION("pushed") {
    const cdem::Selection side = cdem::Selection::where(
        [](const Vec3& x) { return x.x() < 1e-6 && x.z() > 0.01 && x.x() > -1e-6; }, "a side");
    cdem::Fix push = fixed(side, "x");
    push.displacement = Vec3(2e-3, 0, 0);
    s.fix(push);
    REQUIRE(s.relax(options).converged);
    CHECK(s.reaction(side).x() == Approx(weight * std::tan(30 * degree)).epsilon(0.01));
  }
}

TEST_CASE("a support that is moved across a gap pushes a block with its friction, and no harder",
          "[loads][relax]") {
  const double gap = 0.05, way = 0.1; // m
  cdem::ModelSpec spec;
  spec.bodies = {
      meshed("base", box_at({3, 1, 0.4}, {6, 2, 2}, geom::Mat3::Identity(), {1, 0.5, -0.2})),
      meshed("block", box_at({1, 1, 0.4}, {4, 4, 2}, geom::Mat3::Identity(), {0.5, 0.5, 0.2})),
      meshed("pusher", box_at({0.2, 0.8, 0.3}, {1, 2, 2}, geom::Mat3::Identity(), {-0.1 - gap, 0.5, 0.2}))};
  spec.pairs = {{"base", "block", friction(30)}, {"pusher", "block", friction(0)}};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(body_of("base")));
  s.fix(fixed(body_of("pusher")));
  s.gravity(gravity({0, 0, -9.81}));
  cdem::RelaxOptions options;
  options.residual = 1e-5;
  REQUIRE(s.relax(options).converged);
  cdem::Fix push = fixed(body_of("pusher"));
  push.displacement = Vec3(way, 0, 0);
  s.fix(push);
  const cdem::RelaxResult result = s.relax(options);
  REQUIRE(result.converged);
  CHECK(result.broken_while_drawn == 0);
  const double limit = rock().density * 9.81 * 0.4 * std::tan(30 * degree); // N
  CHECK(s.reaction(body_of("pusher")).x() == Approx(limit).epsilon(0.005));
  CHECK(s.mean("displacement.x", body_of("block")) == Approx(way - gap).epsilon(1e-4));
  CHECK(s.energy().friction == Approx(limit * (way - gap)).epsilon(0.005));
  CHECK(s.energy().damping < 0.01 * limit * (way - gap));
  CHECK(s.energy().balance_error() < 1e-4);
}

TEST_CASE("a support with a given velocity moves with it and a later release wins over a fix", "[loads]") {
  cdem::Simulation s = simulation(geom::grid({0.1, 0.1, 0.1}, {1, 1, 1}));
  cdem::Fix move = fixed(cdem::Selection::everything());
  move.velocity = Vec3(0.1, 0, -0.2);
  s.fix(move);
  s.release(cdem::Selection::everything(), axes("z"));
  s.gravity(gravity({5, 0, -9}));
  cdem::RunOptions options;
  options.steps = 100;
  const cdem::RunResult run = s.run(options);
  CHECK(s.min("displacement.x").value == Approx(0.1 * run.time).epsilon(1e-12));
  CHECK(s.max("displacement.x").value == Approx(0.1 * run.time).epsilon(1e-12));
  CHECK(s.max("velocity.z").value ==
        Approx(-9 * (run.time - 0.5 * run.time_step)).epsilon(1e-9)); // free again
  s.clear_loads();
  const double v = s.max("velocity.z").value;
  s.run(options);
  CHECK(s.max("velocity.z").value == Approx(v).epsilon(1e-9));
}

TEST_CASE("a fix that overrules earlier ones of the same place leaves none of them") {
  std::vector<cdem::Fix> fixes;
  const auto fix = [](const cdem::Selection& on, std::array<bool, 3> axes) {
    cdem::Fix f;
    f.on = on;
    f.axes = axes;
    return f;
  };
  const cdem::Selection left = cdem::Selection::side("x-"), right = cdem::Selection::side("x+");
  for (int i = 0; i < 1000; ++i)
    cdem::add_fix(fixes, fix(left, {true, false, false}));
  CHECK(fixes.size() == 1);
  cdem::add_fix(fixes, fix(right, {true, true, true}));
  cdem::add_fix(fixes, fix(left, {false, true, false})); // another axis: both count
  CHECK(fixes.size() == 3);
  cdem::add_fix(fixes, fix(left, {true, true, false}));
  CHECK(fixes.size() == 2);
  const cdem::Selection function = cdem::Selection::where([](const geom::Vec3&) { return true; }, "f");
  cdem::add_fix(fixes, fix(function, {true, true, true}));
  cdem::add_fix(fixes, fix(function, {true, true, true})); // who knows whether it says the same again
  CHECK(fixes.size() == 4);
}

TEST_CASE("thousands of fixes of different places take a time that grows with their number") {
  const auto seconds = [](int calls) {
    cdem::Simulation s({{body("rock", geom::grid({1, 1, 1}, {4, 4, 4}), rock(), rock_joint())}}, 1, nullptr);
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i)
      s.fix(fixed(cdem::Selection::in_box({{-1, -1, -1}, {0.5, 0.5, 0.5 + 1e-5 * i}})));
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const double few = seconds(500);
  CHECK(seconds(4000) < 24 * few); // eight times as many; their square would be 64
}

namespace {

cdem::Fix moved(const cdem::Selection& on, const Vec3& displacement) {
  cdem::Fix fix = fixed(on, "x");
  fix.displacement = displacement;
  return fix;
}

// A bar of 1 m whose end x+ is pulled by 0.1 mm over many periods of it.
cdem::Simulation pulled_bar(int threads, std::shared_ptr<cdem::Observer> observer) {
  cdem::ModelSpec spec;
  spec.bodies = {meshed("bar", geom::box_mesh({1, 0.1, 0.1}, {10, 1, 1}))};
  cdem::Simulation s(spec, threads, std::move(observer));
  s.fix(fixed(cdem::Selection::side("x-"), "x"));
  s.fix(moved(cdem::Selection::side("x+"), {1e-4, 0, 0}));
  return s;
}

} // namespace

TEST_CASE("a displacement of a support is reached at a steady velocity at the end of a run, and held",
          "[loads]") {
  cdem::Simulation s = pulled_bar(1, nullptr);
  cdem::RunOptions run;
  run.duration = 0.02;
  run.local_damping = 0.05;
  double half = 0;
  run.callback_every = 10;
  run.callback = [&] {
    if (half == 0 && s.time() >= 0.01)
      half = s.mean("displacement.x", cdem::Selection::side("x+")) / s.time();
  };
  s.run(run);
  CHECK(half == Approx(1e-4 / 0.02).epsilon(1e-3));
  CHECK(s.mean("displacement.x", cdem::Selection::side("x+")) == Approx(1e-4).epsilon(1e-10));
  const double force = rock().youngs_modulus * 0.01 * 1e-4; // E A u / L
  CHECK(s.reaction(cdem::Selection::side("x+")).x() == Approx(force).epsilon(0.01));
  run.duration = 0.002;
  run.callback = {};
  s.run(run);
  CHECK(s.mean("displacement.x", cdem::Selection::side("x+")) == Approx(1e-4).epsilon(1e-10));
}

TEST_CASE("a run that moves a support to a displacement goes on to the same bits", "[loads][checkpoint]") {
  const auto solve = [](cdem::Simulation& s, int) {
    cdem::RunOptions run;
    run.steps = 1000;
    s.run(run);
    return Figures{s.mean("displacement.x", cdem::Selection::side("x+")), s.energy().external};
  };
  check_going_on(pulled_bar, solve, {20, 40});
}

TEST_CASE("settle has no end at which a support could be somewhere", "[loads]") {
  cdem::Simulation s = pulled_bar(1, nullptr);
  s.gravity(gravity());
  CHECK_THROWS_WITH(s.settle({}), Catch::Matchers::Contains("displacement of fix: settle") &&
                                      Catch::Matchers::Contains("move it by model:relax or model:run"));
}
