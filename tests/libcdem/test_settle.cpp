// Cubes dropped on a floor come to rest, as rigid bodies first.
#include "libcdem/procedure/settle.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/results/units.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

constexpr double unit_side = 0.5; // m, of the cubes
const Vec3 g(0, 0, -9.81);

geom::TetMesh cube_at(const Vec3& centre, const Mat3& turn) {
  geom::TetMesh mesh = geom::box_mesh({unit_side, unit_side, unit_side}, {2, 2, 2});
  for (Vec3& x : mesh.nodes)
    x = turn * (x - Vec3::Constant(0.5 * unit_side)) + centre;
  return mesh;
}

// One on its face, one on an edge, and one that falls on the first.
cdem::Simulation cubes(std::shared_ptr<cdem::Observer> observer = nullptr) {
  cdem::Elastic soft = rock(); // large steps
  soft.youngs_modulus = 2e8;
  const Mat3 straight = Mat3::Identity();
  return units_over_floor(geom::box_mesh({3, 1.5, 0.5}, {6, 3, 1}),
                          {cube_at({0.6, 0.75, 0.5 + 0.25 + 0.05}, straight),
                           cube_at({2.0, 0.75, 0.5 + 0.45}, rotation({0, 1, 0}, 30 * degree)),
                           cube_at({0.62, 0.73, 0.5 + 0.85 + 0.05}, straight)},
                          soft, 1, std::move(observer));
}

struct Lines final : cdem::Observer {
  std::vector<std::string> lines;
  void message(const std::string& line) override { lines.push_back(line); }
};

} // namespace

TEST_CASE("settle: dropped cubes come to rest on their faces, one on another, and carry their weight",
          "[settle]") {
  auto lines = std::make_shared<Lines>();
  cdem::Simulation s = cubes(lines);
  cdem::SettleOptions options;
  options.max_time = 10;
  options.safety = 0.2; // impacts in steps that keep the energy
  int calls = 0;
  options.callback_every = 100;
  options.callback = [&] { ++calls; };
  const cdem::SettleResult result = s.settle(options);
  REQUIRE(result.converged);
  CHECK(result.kinetic_ratio <= 1e-6);
  CHECK(result.made_rigid == 3);
  REQUIRE(result.phases.size() == 2);
  CHECK(result.phases[0].name == "rigid fall");
  CHECK(result.phases[1].name == "deformable");
  CHECK(result.phases[0].kinetic_ratio <= 1e-6);
  CHECK(result.steps == result.phases[0].steps + result.phases[1].steps);
  CHECK(s.stage() == 1);
  CHECK(calls > 10);
  REQUIRE_FALSE(lines->lines.empty());
  CHECK_THAT(lines->lines[0], Catch::Contains("3 units are rigid") && Catch::Contains("off afterwards"));

  const double heights[] = {0.25, 0.25, 0.75}; // over the floor
  const auto blocks = s.blocks();
  for (int unit = 0; unit < 3; ++unit) {
    INFO("unit " << unit + 1);
    const auto& block = blocks[unit + 1];
    // Pressed in and together by parts of a millimetre.
    CHECK((block.centroid + block.displacement).z() - 0.5 == Approx(heights[unit]).margin(1e-3));
  }
  const double weight = rock().density * 3 * unit_side * unit_side * unit_side * -g.z();
  CHECK(s.reaction(cdem::Selection::of_body("floor")).z() ==
        Approx(weight + rock().density * 3 * 1.5 * 0.5 * -g.z()).epsilon(1e-3));
  CHECK(s.energy().balance_error() < 0.01);
}

TEST_CASE("settle: a stiff cube has taken up its weight when it has settled, however small the steps",
          "[settle]") {
  const double h = 0.5;
  const int n = GENERATE(4, 8);
  cdem::Elastic concrete = rock();
  concrete.youngs_modulus = 30e9;
  geom::TetMesh cube = geom::box_mesh({h, h, h}, {n, n, n});
  for (Vec3& x : cube.nodes)
    x += Vec3(0.5, 0.5, 0.5 + 0.05);
  cdem::Simulation s =
      units_over_floor(geom::box_mesh({1.5, 1.5, 0.5}, {3, 3, 1}), {cube}, concrete, 1, nullptr);
  cdem::SettleOptions options;
  options.kinetic_energy_ratio = 1e-4;
  options.local_damping = 0.1; // five times as long as usual
  const cdem::SettleResult result = s.settle(options);
  REQUIRE(result.converged);
  CHECK(result.phases.back().name == "deformable");
  INFO(n << " tets a side, steps of " << result.phases.back().time / double(result.phases.back().steps)
         << " s");
  CHECK(result.phases.back().residual <= 0.01);
  // In balance the volume's mean of stress zz is that of the weight's moments, - rho g h / 2, for any field.
  CHECK(s.mean("stress.zz", cdem::Selection::of_body("units")) ==
        Approx(0.5 * concrete.density * g.z() * h).epsilon(0.01));
}

TEST_CASE("settle: deformable units fall freely until the first touch, and time that is up is told",
          "[settle]") {
  cdem::Simulation s = cubes();
  cdem::SettleOptions options;
  options.rigid = false;
  options.max_time = 0.12; // the first touches after 0.1 s
  const cdem::SettleResult result = s.settle(options);
  CHECK_FALSE(result.converged);
  CHECK(result.made_rigid == 0);
  REQUIRE(result.phases.size() == 2);
  CHECK(result.phases[0].name == "free fall");
  const double falls = std::sqrt(2 * 0.05 / 9.81),
               step = result.phases[0].time / static_cast<double>(result.phases[0].steps);
  CHECK(result.phases[0].time > falls);
  CHECK(result.phases[0].time < falls + 21 * step); // 20 between looks
  CHECK(result.phases[1].name == "deformable");
  CHECK(result.time == Approx(0.12).epsilon(0.01));
}

TEST_CASE("settle: one unit is told of as one", "[settle]") {
  const auto lines = std::make_shared<Lines>();
  cdem::Simulation s =
      units_over_floor(geom::box_mesh({2, 1.5, 0.5}, {4, 3, 1}),
                       {cube_at({0.6, 0.75, 0.5 + 0.25 + 0.05}, Mat3::Identity())}, rock(), 1, lines);
  cdem::SettleOptions options;
  options.max_time = 1e-3;
  CHECK(s.settle(options).fastest == "\"units\"");
  REQUIRE_FALSE(lines->lines.empty());
  CHECK_THAT(lines->lines[0], Catch::Contains("alone 1 unit is rigid, with "));
}

TEST_CASE("settle: a fall of rigid units is ballistic until they touch", "[settle]") {
  cdem::Simulation s = cubes();
  cdem::SettleOptions options;
  options.max_time = 0.05;
  const cdem::SettleResult result = s.settle(options);
  const double t = s.time();
  CHECK_FALSE(result.converged);
  CHECK_THAT(result.fastest, Catch::EndsWith(" of \"units\"")); // all three fall alike
  const double half_step = 0.5 * result.time / static_cast<double>(result.steps);
  CHECK(result.fastest_speed == Approx(-g.z() * (t - half_step)).epsilon(1e-3));
  CHECK(s.blocks()[1].displacement.z() == Approx(0.5 * g.z() * t * t).epsilon(1e-6));
}

TEST_CASE("settle: rigid units at rest that may deform from then on are not kicked by half a step of the "
          "rigid ones",
          "[settle][rigid]") {
  const cdem::Selection units = cdem::Selection::of_body("units");
  cdem::Simulation s =
      units_over_floor(geom::box_mesh({3, 1.5, 0.5}, {6, 3, 1}),
                       {cube_at({0.6, 0.75, 0.5 + 0.25}, Mat3::Identity())}, rock(), 1, nullptr);
  s.make_rigid(units);
  cdem::SettleOptions options;
  options.max_time = 10;
  REQUIRE(s.settle(options).converged);
  const auto open_balance = [](const cdem::Simulation& of) {
    return of.energy().total() - of.energy().external;
  };
  const double stored = s.energy().springs, open = open_balance(s);
  CHECK(stored > 0);
  s.make_deformable(units);
  CHECK(s.energy().springs == Approx(stored).epsilon(1e-6));
  CHECK(open_balance(s) == Approx(open).margin(1e-4 * stored));
  CHECK(s.energy().kinetic < 1e-4 * stored);
  // From rest the first step gives v = F dt / 2m, which is dt^2 / 8 sum F^2 / m of kinetic energy, whatever the steps
  // were before. The balance of central differences is off by as much: the velocity counts in it for the whole of the
  // half step through which it grows from 0.
  const double steps[] = {1e-5, 1e-6}; // small against the stable one
  double kinetic[2];
  for (int i = 0; i < 2; ++i) {
    cdem::Simulation first = s.copy();
    cdem::RunOptions one;
    one.steps = 1;
    one.time_step = steps[i];
    first.run(one);
    kinetic[i] = first.energy().kinetic;
    CHECK(open_balance(first) - open == Approx(-kinetic[i]).epsilon(0.1));
  }
  CHECK(kinetic[0] == Approx(100 * kinetic[1]).epsilon(0.01));
  CHECK(kinetic[1] < 1e-3 * stored);
}

TEST_CASE("a rigid unit that flies and may deform from then on keeps its parabola", "[settle][rigid]") {
  const cdem::Selection units = cdem::Selection::of_body("units");
  cdem::Simulation s = units_over_floor(geom::box_mesh({3, 1.5, 0.5}, {6, 3, 1}),
                                        {cube_at({0.6, 0.75, 3}, Mat3::Identity())}, rock(), 1, nullptr);
  s.make_rigid(units);
  const Vec3 thrown(0.3, 0, 2);
  s.initial_velocity(units, thrown);
  cdem::RunOptions steps;
  steps.steps = 500;
  steps.time_step = 8e-5;
  s.run(steps);
  s.make_deformable(units);
  steps.time_step = 0;
  steps.steps = 300;
  s.run(steps);
  const double t = s.time();
  const Vec3 moved = s.blocks()[1].displacement, should = t * thrown + 0.5 * t * t * g;
  CHECK((moved - should).norm() < 1e-9);
}

TEST_CASE("settle: with less friction a cube slides while it settles, and no longer", "[settle]") {
  // A plate of 20 degrees (gravity is turned), friction of 30, of 10 while the cube settles.
  const double slope = 20 * degree, time = 0.2;
  cdem::Joint friction;
  friction.bonded = false;
  friction.friction_angle = 30 * degree;
  cdem::BodySpec plate = meshed("plate", geom::box_mesh({3, 1.5, 0.5}, {6, 3, 1}));
  plate.element = cdem::Element::rigid;
  const Vec3 start(0.7, 0.75, 0.5 + 0.5 * unit_side);
  cdem::ModelSpec spec;
  // Without damping what slides with friction comes to rattle, by 0.1 mm, and creeps down for a while once it has stopped.
  cdem::Elastic damped = rock();
  damped.stiffness_damping = 1e-5;
  spec.bodies = {plate, meshed("cube", cube_at(start, Mat3::Identity()), {}, damped)};
  spec.pairs = {{"plate", "cube", friction}};
  cdem::Simulation s(spec, 1, nullptr);
  cdem::Fix hold;
  hold.on = cdem::Selection::of_body("plate");
  s.fix(hold);
  cdem::Gravity gravity;
  gravity.acceleration = 9.81 * Vec3(std::sin(slope), 0, -std::cos(slope));
  s.gravity(gravity);
  const auto slid = [&] {
    return cdem::units_of(s.model(), s.state(), "cube")[0].motion(start).x() - start.x();
  };

  cdem::SettleOptions options;
  options.local_damping = 0;
  options.max_time = time;
  options.friction_angle = 10 * degree;
  CHECK_FALSE(s.settle(options).converged);
  const auto acceleration = [&](double phi) {
    return 9.81 * (std::sin(slope) - std::tan(phi) * std::cos(slope));
  };
  const double way = 0.5 * acceleration(10 * degree) * time * time;
  CHECK(slid() == Approx(way).epsilon(0.02));

  cdem::RunOptions on;
  on.duration = 0.25;
  s.run(on);
  CHECK(slid() == Approx(way * (1 - acceleration(10 * degree) / acceleration(30 * degree))).epsilon(0.02));
}

TEST_CASE("settle: wrong goals are refused", "[settle][input]") {
  cdem::Simulation s = cubes();
  const auto refused = [&](auto change) {
    cdem::SettleOptions options;
    change(options);
    return [&s, options] { s.settle(options); };
  };
  CHECK_THROWS_WITH(refused([](auto& o) { o.kinetic_energy_ratio = 1; })(),
                    Catch::Contains("kinetic_energy_ratio = 1"));
  CHECK_THROWS_WITH(refused([](auto& o) { o.local_damping = 1; })(), Catch::Contains("local_damping = 1"));
  CHECK_THROWS_WITH(refused([](auto& o) { o.friction_angle = -0.1; })(),
                    Catch::Contains("friction_angle = -0.1"));
  CHECK_THROWS_WITH(refused([](auto& o) { o.max_time = 0; })(), Catch::Contains("max_time = 0"));
}
