// Forces of fields of water on bodies: buoyancy, drag on silhouettes, Morison's inertia, each counted once.
#include "libcdem/load/water_forces.hpp"
#include "libcdem/procedure/turn_rigid.hpp"
#include "libcdem/results/energy.hpp"
#include "libcdem/water/steady_wave.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/polyhedron/cut.hpp"
#include "tests/libcdem/going_on.hpp"
#include "tests/libcdem/in_water.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

using namespace testing;
using geom::Vec3;

namespace {

// A box of divisions n, its surface moved to a sphere of radius 0.5, or its sides to a cylinder of diameter and height 1,
// whose points wander along the axis, so that no triangle of the side is parallel to it.
enum class Shape { cube, sphere, cylinder };
geom::TetMesh shaped(Shape shape, int n) {
  geom::TetMesh mesh = geom::box_mesh({1, 1, 1}, {n, n, n});
  for (Vec3& x : mesh.nodes) {
    x -= Vec3(0.5, 0.5, 0.5);
    if (shape == Shape::sphere) {
      const double cube = x.cwiseAbs().maxCoeff(), length = x.norm();
      if (length > 0)
        x *= cube / length;
    } else if (shape == Shape::cylinder) {
      const double square = std::max(std::abs(x.x()), std::abs(x.y())), length = std::hypot(x.x(), x.y());
      if (length > 0)
        x.x() *= square / length, x.y() *= square / length;
      x.z() += 0.2 / n * std::sin(5 * std::atan2(x.y(), x.x()) + 40 * x.z()) * (1 - 4 * x.z() * x.z());
    }
  }
  return mesh;
}

// A cube of 1 m in a wave, and the wave's velocity and acceleration without its pressure.
struct CubeInWave {
  std::shared_ptr<const cdem::WaveField> wave;
  cdem::FunctionWater without;
  System system;
};

CubeInWave cube_in_wave() {
  cdem::WaveGiven given;
  given.height = 3;
  given.period = 9;
  given.depth = 15;
  const auto wave = std::make_shared<cdem::WaveField>(given);
  cdem::FunctionWater without;
  without.velocity = [wave](const Vec3& x, double t) { return wave->at(x, t).velocity; };
  without.acceleration = [wave](const Vec3& x, double t) { return wave->at(x, t).acceleration; };
  geom::TetMesh cube = shaped(Shape::cube, 3);
  for (Vec3& x : cube.nodes)
    x += Vec3(4, 0, -6);
  return {wave, without, System(build({meshed("unit", cube)}))};
}

} // namespace

TEST_CASE("still water carries a body as Archimedes said, at any attitude and draught", "[water]") {
  const Vec3 size(1, 0.6, 1.7);
  enum class Kind { mesh, rigid_mesh, block, rigid_block, block_of_small_strain, zoned_block };
  const Kind kind = GENERATE(Kind::mesh, Kind::rigid_mesh, Kind::block, Kind::rigid_block,
                             Kind::block_of_small_strain, Kind::zoned_block);
  CAPTURE(static_cast<int>(kind));
  const bool is_mesh = kind == Kind::mesh || kind == Kind::rigid_mesh;
  cdem::BodySpec unit =
      is_mesh ? meshed("unit", geom::box_mesh(size, {2, 2, 3})) : body("unit", geom::grid(size, {1, 1, 1}));
  if (kind == Kind::block || kind == Kind::zoned_block)
    unit.element = cdem::Element::finite_volume;
  if (kind == Kind::rigid_block)
    unit.element = cdem::Element::rigid;
  if (kind == Kind::zoned_block)
    unit.zone_size = 0.5;
  System s(build({unit}));
  if (kind == Kind::rigid_mesh)
    cdem::set_rigid(s.model, s.state, {0});
  for (const double angle : {0.0, 33.0, 100.0})
    for (const double level : {-3.0, 0.1, 0.45, 0.9, 5.0}) {
      const geom::Mat3 turn = rotation({1, -2, 0.5}, angle * degree);
      geom::Polyhedron box = geom::grid(size, {1, 1, 1}).blocks.at(0);
      for (std::size_t i = 0; i < s.state.displacement.size(); ++i)
        s.state.displacement[i] = node(turn * s.model.node_position[i] - s.model.node_position[i]);
      for (Vec3& x : box.vertices)
        x = turn * x;
      s.conditions.flows = {in_water(cdem::uniform_water(still(level)))};
      const Wrench sum = wrench(s);
      const geom::Cut parts = geom::cut(box, geom::Plane{Vec3::UnitZ(), level});
      Wrench expected;
      if (parts.below || !parts.above) {
        const geom::MassProperties wet = geom::mass_properties(parts.below ? parts.below->shape : box);
        expected.force = wet.volume * sea_weight * Vec3::UnitZ();
        expected.moment = wet.centroid.cross(expected.force);
      }
      CHECK((sum.force - expected.force).norm() < 1e-12 * sea_weight);
      CHECK((sum.moment - expected.moment).norm() < 1e-12 * sea_weight);
    }
}

TEST_CASE("drag on a convex body is that of its silhouette, the side along a stream takes nothing",
          "[water][flow]") {
  const double speed = 3, pressure = 0.5 * sea_density * speed * speed;
  const auto drag = [&](Shape shape, const Vec3& along, bool field) {
    System s(build({meshed("unit", shaped(shape, 8))}));
    if (field) {
      s.conditions.flows = {in_water(stream(speed * along), 1)};
    } else {
      cdem::Flow flow;
      flow.direction = along;
      flow.velocity = [=](double) { return speed; };
      flow.relative = false;
      s.conditions.flows = {flow};
    }
    s.state.time = 1;
    const Vec3 force = wrench(s).force;
    CHECK((force - force.dot(along) * along).norm() < 1e-9 * force.norm());
    return force.dot(along) / pressure;
  };
  const bool field = GENERATE(true, false);
  CHECK(drag(Shape::cube, Vec3::UnitX(), field) == Approx(1).epsilon(1e-12));
  CHECK(drag(Shape::cube, Vec3(1, 1, 1).normalized(), field) == Approx(std::sqrt(3)).epsilon(1e-12));
  CHECK(drag(Shape::sphere, Vec3(1, 2, 0.3).normalized(), field) == Approx(pi / 4).epsilon(0.02));
  CHECK(drag(Shape::cylinder, Vec3::UnitX(), field) == Approx(1).epsilon(0.02));
  double end = 0; // m2, of the mesh
  System cylinder(build({meshed("unit", shaped(Shape::cylinder, 8))}));
  for (const cdem::OuterFace& face : cylinder.model.outer_faces)
    if (face.normal.z() < -0.999)
      end += face.area;
  CHECK(drag(Shape::cylinder, Vec3::UnitZ(), field) == Approx(end).epsilon(0.01));
}

TEST_CASE("a body at rest in accelerated water takes Morison's force", "[water]") {
  const Shape shape = GENERATE(Shape::cube, Shape::sphere, Shape::cylinder);
  const double cd = 0.8, ca = 0.6, area = shape == Shape::sphere ? pi / 4 : 1;
  const Vec3 u(2, 0, 0), a(-0.7, 0, 0);
  System s(build({meshed("unit", shaped(shape, 6))}));
  s.conditions.flows = {in_water(stream(u, a), cd, ca)};
  s.state.time = 1;
  double volume = 0;
  for (int i = 0; i < static_cast<int>(s.model.node_position.size()); ++i)
    volume += cdem::node_volume(s.model, i);
  const Vec3 inertia = sea_density * volume * (1 + ca) * a,
             drag = 0.5 * sea_density * cd * area * u.norm() * u;
  const Wrench sum = wrench(s);
  CHECK((sum.force - inertia - drag).norm() < 0.03 * drag.norm());
  s.conditions.flows[0].drag = 0;
  CHECK((wrench(s).force - inertia).norm() < 1e-9 * inertia.norm());
}

TEST_CASE("a field with pressure and one with acceleration give the same force, neither twice", "[water]") {
  auto [wave, without, s] = cube_in_wave();
  const double ca = GENERATE(0.0, 0.67);
  for (const double time : {0.0, 1.7, 4.0}) {
    s.state.time = time;
    s.conditions.flows = {in_water(wave, 0, ca)};
    const Vec3 by_pressure = wrench(s).force - sea_weight * Vec3::UnitZ();
    s.conditions.flows = {in_water(cdem::function_water(without), 0, ca)};
    const Vec3 by_acceleration = wrench(s).force;
    CHECK(by_acceleration.norm() > 300);
    CHECK((by_pressure - by_acceleration).norm() < 0.01 * by_acceleration.norm());
  }
}

TEST_CASE("a body sinks with its weight less buoyancy over its mass and the added one", "[water][rigid]") {
  const bool rigid = GENERATE(false, true);
  const double ca = 0.67, rock_density = rock().density;
  System s(build({meshed("unit", geom::box_mesh({1, 1, 1}, {2, 2, 2}))}));
  if (rigid)
    cdem::set_rigid(s.model, s.state, {0});
  s.conditions.gravity = gravity();
  s.conditions.flows = {in_water(cdem::uniform_water(still(1.5)), 0, ca)};
  cdem::RunOptions options;
  options.duration = 0.01;
  options.time_step = 5e-5;
  s.run(options);
  const double expected = -9.81 * (rock_density - sea_density) / (rock_density + ca * sea_density);
  double mean = 0; // m, of the mass
  for (int i = 0; i < static_cast<int>(s.state.displacement.size()); ++i)
    mean += s.state.displacement[i].z * cdem::node_volume(s.model, i);
  CHECK(mean == Approx(0.5 * expected * 1e-4).epsilon(0.003));
  CHECK(s.state.moving_mass.empty());
  CHECK(cdem::energy(s.model, s.state).balance_error() < 1e-3);
}

TEST_CASE("still water gives no turn and no energy to a body that turns in it", "[water][rigid]") {
  const bool rigid = GENERATE(false, true);
  cdem::Elastic neutral = rock();
  neutral.density = sea_density;
  System s(build({meshed("unit", geom::box_mesh({1, 1, 1}, {2, 2, 2}), {}, neutral)}));
  const Vec3 spin(0.3, 0, 0.4), centre(0.5, 0.5, 0.5); // rad/s, m
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i)
    s.state.velocity[i] = node(spin.cross(s.model.node_position[i] - centre));
  if (rigid)
    cdem::set_rigid(s.model, s.state, {0});
  // That of the nodes is not that of a rigid cube, whose axes turn.
  const auto angular = [&] {
    return rigid ? Vec3(s.state.rigid[0].angular_momentum.data()) : momentum(s, Places::present).angular;
  };
  const Vec3 before = angular();
  s.conditions.gravity = gravity();
  s.conditions.flows = {in_water(cdem::uniform_water(still(8)), 0)};
  cdem::RunOptions options;
  options.duration = rigid ? 4 : 0.1;
  options.time_step = rigid ? 1e-3 : 0;
  s.run(options);
  CHECK((angular() - before).norm() < (rigid ? 1e-9 : 1e-4) * before.norm());
  if (rigid)
    CHECK(cdem::energy(s.model, s.state).kinetic ==
          Approx(0.5 * sea_density / 6 * spin.squaredNorm()).epsilon(1e-9)); // of a cube of 1 m
}

TEST_CASE("a body that floats heaves with the period of its water line, and no higher than it began",
          "[water][rigid]") {
  const double draught = 0.2, height = 0.4, offset = 0.03;
  const double ca = GENERATE(0.0, 0.5);
  cdem::Elastic light = rock();
  light.density = 0.5 * sea_density;
  System s(build({meshed("raft", geom::box_mesh({1.2, 0.8, height}, {3, 2, 2}), {}, light)}));
  cdem::set_rigid(s.model, s.state, {0});
  s.conditions.gravity = gravity();
  s.conditions.flows = {in_water(cdem::uniform_water(still(draught + offset)), 0, ca)};
  const double period = 2 * pi * std::sqrt((1 + ca) * draught / 9.81); // of the draught at rest
  cdem::RunOptions options;
  options.time_step = 1e-3;
  options.duration = 6 * period;
  double highest_first = 0, highest_last = 0; // m, over the place of rest
  options.callback = [&] {
    const double z = std::abs(s.state.displacement[0].z - offset);
    double& highest = s.state.time < period ? highest_first : highest_last;
    if (s.state.time < period || s.state.time > 5 * period)
      highest = std::max(highest, z);
  };
  options.callback_every = 1;
  s.run(options);
  CHECK(highest_first == Approx(offset).epsilon(ca > 0 ? 0.1 : 0.01));
  CHECK(highest_last < 1.0001 * highest_first);
  if (ca == 0) // after whole periods it is where it began
    CHECK(std::abs(s.state.displacement[0].z) < 0.01 * offset);
}

TEST_CASE("a body that heaves far without drag keeps its energy, whatever the time step", "[water][rigid]") {
  // 0.1 m above its rest at a draught of 0.29 m, 75 times up and down.
  const double ca = GENERATE(0.5, 1.0), angle = GENERATE(0.0, 20.0), time_step = GENERATE(0.01, 0.005);
  CAPTURE(ca, angle, time_step);
  cdem::Elastic wood = rock();
  wood.density = 600;
  geom::TetMesh box = geom::box_mesh({1, 0.8, 0.5}, {1, 1, 1});
  for (Vec3& x : box.nodes)
    x = rotation(Vec3::UnitY(), angle * degree) * (x - Vec3(0.5, 0.4, 0.5 * 600 / sea_density)) +
        0.1 * Vec3::UnitZ();
  System s(build({meshed("unit", box, {}, wood)}));
  cdem::set_rigid(s.model, s.state, {0});
  s.conditions.gravity = gravity();
  s.conditions.flows = {in_water(cdem::uniform_water(still(0)), 0, ca)};
  cdem::RunOptions options;
  options.time_step = time_step;
  options.duration = 150;
  double first = 0, last = 0; // J
  options.callback = [&] {
    const double kinetic = cdem::kinetic_energy(s.model, s.state);
    double& largest = s.state.time < 75 ? first : last;
    largest = std::max(largest, kinetic);
  };
  options.callback_every = 1;
  s.run(options);
  CHECK(last == Approx(first).epsilon(0.01));
  CHECK(cdem::energy(s.model, s.state).balance_error() < 1e-9);
}

TEST_CASE("the time step does not decide where waves take a float", "[water][rigid]") {
  cdem::WaveGiven given;
  given.height = 0.3;
  given.period = 3;
  given.depth = 8;
  const auto wave = std::make_shared<cdem::WaveField>(given);
  const auto drift = [&](double time_step) { // m, in two periods
    cdem::Elastic wood = rock();
    wood.density = 600;
    geom::TetMesh box = geom::box_mesh({1, 1, 0.5}, {2, 2, 2});
    for (Vec3& x : box.nodes)
      x -= Vec3(0.5, 0.5, 0.3);
    System s(build({meshed("float", box, {}, wood)}));
    cdem::set_rigid(s.model, s.state, {0});
    s.conditions.gravity = gravity();
    s.conditions.flows = {in_water(wave, 1, 0.5)};
    cdem::RunOptions options;
    options.time_step = time_step;
    options.duration = 6;
    s.run(options);
    return s.state.rigid[0].centroid[0] - s.model.blocks[0].mass.centroid.x();
  };
  const double fine = drift(0.001);
  CHECK(drift(0.01) == Approx(fine).margin(0.02));
  CHECK(drift(0.05) == Approx(fine).margin(0.1));
}

TEST_CASE("the added mass of a body that floats is that of its wet volume, for any mesh", "[water]") {
  const int divisions = GENERATE(1, 2, 3);
  System s(build({meshed("unit", geom::box_mesh({1, 1, 1}, {divisions, divisions, divisions}))}));
  for (const double angle : {0.0, 35.0})
    for (const double level : {0.1, 0.45, 0.8}) {
      const geom::Mat3 turn = rotation({1, -2, 0.5}, angle * degree);
      geom::Polyhedron box = geom::grid({1, 1, 1}, {1, 1, 1}).blocks.at(0);
      for (std::size_t i = 0; i < s.state.displacement.size(); ++i)
        s.state.displacement[i] = node(turn * s.model.node_position[i] - s.model.node_position[i]);
      for (Vec3& x : box.vertices)
        x = turn * x;
      const double wet = geom::mass_properties(geom::cut(box, {Vec3::UnitZ(), level}).below->shape).volume;
      cdem::UniformWater water = still(level);
      water.velocity = [](double t) { return Vec3(0.3 * t, 0, 0); };
      s.conditions.flows = {in_water(cdem::uniform_water(water), 0, 0.7)};
      const cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
      double mass = 0;
      for (const double m : r.water_mass)
        mass += m;
      CHECK(mass == Approx(0.7 * sea_density * wet).epsilon(1e-12));
      CHECK(wrench(s).force.x() == Approx(1.7 * sea_density * wet * 0.3).epsilon(1e-6));
    }
}

TEST_CASE("a surface without a pressure leaves out no force of accelerated water, and counts none twice",
          "[water]") {
  auto [wave, surface, s] = cube_in_wave();
  surface.surface = [wave = wave](const Vec3& x, double t) { return wave->at(x, t).surface; };
  for (const double time : {0.0, 1.2, 2.9}) {
    s.state.time = time;
    s.conditions.flows = {in_water(wave, 0)};
    const Vec3 by_pressure = wrench(s).force - sea_weight * Vec3::UnitZ();
    s.conditions.flows = {in_water(cdem::function_water(surface), 0)};
    const Vec3 by_surface = wrench(s).force - sea_weight * Vec3::UnitZ();
    CHECK(by_pressure.norm() > 300);
    CHECK((by_surface - by_pressure).norm() < 0.02 * by_pressure.norm());
  }
  // Under a level surface all of it comes from the acceleration.
  cdem::FunctionWater level;
  level.velocity = [](const Vec3&, double t) { return Vec3(1.5 * t, 0, 0); };
  level.surface = [](const Vec3&, double) { return 2.0; };
  s.conditions.flows = {in_water(cdem::function_water(level), 0)};
  CHECK(wrench(s).force.x() == Approx(sea_density * 1.5).epsilon(1e-6));
}

TEST_CASE("no water stands or flows in a cavity that its body closes", "[water][flow]") {
  geom::TetMesh full = geom::box_mesh({1.5, 1.5, 1.5}, {3, 3, 3}), hollow = full;
  hollow.tets.clear();
  for (const geom::Tet& tet : full.tets) {
    Vec3 middle = Vec3::Zero();
    for (const int node : tet)
      middle += 0.25 * full.nodes[node];
    if (((middle - Vec3(0.75, 0.75, 0.75)).array().abs() > 0.25).any())
      hollow.tets.push_back(tet);
  }
  const auto force = [](const geom::TetMesh& mesh, std::shared_ptr<const cdem::WaterField> water) {
    System s(build({meshed("unit", mesh)}));
    s.conditions.flows = {in_water(std::move(water))};
    s.state.time = 1;
    return wrench(s).force;
  };
  const double volume = 1.5 * 1.5 * 1.5;
  const Vec3 at_rest = Vec3::Zero(), accelerated(0.4, 0, -0.2); // the body displaces the cavity too
  CHECK((force(hollow, stream(at_rest, accelerated)) - sea_density * volume * accelerated).norm() <
        1e-6 * sea_density);
  for (const double level : {0.6, 0.75, 0.9, 3.0}) {
    cdem::UniformWater water = still(level);
    water.velocity = [=](double t) { return Vec3(t * accelerated.x(), 0, 0); };
    System s(build({meshed("unit", hollow)}));
    s.conditions.flows = {in_water(cdem::uniform_water(water), 0, 0.67)};
    s.state.time = 1;
    const double wet = volume * std::min(1.0, level / 1.5);
    CHECK(wrench(s).force.x() == Approx(1.67 * sea_density * wet * accelerated.x()).epsilon(1e-6));
    const cdem::ResolvedConditions r = cdem::resolve(s.model, s.state, s.conditions);
    CHECK(std::accumulate(r.water_mass.begin(), r.water_mass.end(), 0.0) ==
          Approx(0.67 * sea_density * wet).epsilon(1e-12));
  }
  CHECK((force(hollow, cdem::uniform_water(still(3))) - volume * sea_weight * Vec3::UnitZ()).norm() <
        1e-9 * sea_weight);
  const Vec3 u(2, 0, 0);
  CHECK((force(hollow, stream(u)) - force(full, stream(u))).norm() < 1e-9 * sea_density);
  cdem::Flow flow;
  flow.direction = Vec3::UnitX();
  flow.velocity = [](double) { return 2; };
  System s(build({meshed("unit", hollow)}));
  s.conditions.flows = {flow};
  CHECK(wrench(s).force.x() == Approx(0.5 * sea_density * 4 * 1.5 * 1.5));
  cdem::ModelSpec spec;
  spec.bodies = {meshed("unit", hollow)};
  cdem::Simulation given(spec, 1, nullptr);
  flow.on = {cdem::Selection::in_box({{0.4, 0.4, 0.4}, {1.1, 1.1, 1.1}})};
  CHECK_THROWS_WITH(given.flow(flow), Catch::Contains("cavities that a mesh closes"));
}

TEST_CASE("accelerated water takes a body once, and no body of which it meets a part", "[water]") {
  const Vec3 acceleration(2, 0, 0);
  const auto field = stream(Vec3::Zero(), acceleration);
  System s(build({meshed("unit", geom::box_mesh({1, 1, 1}, {2, 2, 2}))}));
  s.state.time = 1;
  const auto force_on = [&](const std::vector<std::vector<std::string>>& calls) {
    s.conditions.flows.clear();
    for (const std::vector<std::string>& sides : calls) {
      cdem::Flow flow = in_water(field, 0);
      flow.on = {cdem::Selection::side(sides[0])};
      for (std::size_t i = 1; i < sides.size(); ++i)
        flow.on.push_back(cdem::Selection::side(sides[i]));
      s.conditions.flows.push_back(flow);
    }
    return wrench(s).force;
  };
  CHECK((force_on({{"x-", "x+", "y-", "y+", "z-", "z+"}}) - sea_density * acceleration).norm() <
        1e-6 * sea_density);
  CHECK(force_on({{"y-"}}).isZero(0));
  CHECK(force_on({{"x-"}, {"x+"}}).isZero(0));
  // A unit of a body of two is a whole.
  geom::TetMesh two = geom::box_mesh({1, 1, 1}, {1, 1, 1});
  const auto nodes = static_cast<int>(two.nodes.size()), tets = static_cast<int>(two.tets.size());
  for (int i = 0; i < nodes; ++i)
    two.nodes.push_back(two.nodes[i] + Vec3(3, 0, 0));
  for (int t = 0; t < tets; ++t) {
    geom::Tet tet = two.tets[t];
    for (int& node : tet)
      node += nodes;
    two.tets.push_back(tet);
  }
  two.region.assign(two.tets.size(), 0);
  System units(build({meshed("units", two)}));
  units.state.time = 1;
  cdem::Flow one = in_water(field, 0, 0.5);
  one.on = {cdem::Selection::of_units("units", {2})};
  units.conditions.flows = {one};
  CHECK((wrench(units).force - 1.5 * sea_density * acceleration).norm() < 1e-6 * sea_density);
  cdem::ModelSpec spec;
  spec.bodies = {meshed("unit", geom::box_mesh({1, 1, 1}, {2, 2, 2}))};
  cdem::Simulation given(spec, 1, nullptr);
  cdem::Flow part = in_water(field, 1, 0.5);
  part.on = {cdem::Selection::side("x-")};
  CHECK_THROWS_WITH(given.flow(part), Catch::Contains("name whole units"));
  part.added_mass = 0;
  CHECK_NOTHROW(given.flow(part));
}

TEST_CASE("a run in waves that is left and goes on ends in the same bits", "[water][resume]") {
  cdem::WaveGiven given;
  given.height = 0.4;
  given.period = 3;
  given.depth = 2;
  given.level = 0.7;
  const auto wave = std::make_shared<cdem::WaveField>(given);
  const bool rigid = GENERATE(false, true);
  const auto unit_in_waves = [&](int threads, std::shared_ptr<cdem::Observer> observer) {
    cdem::ModelSpec spec;
    spec.bodies = {meshed("unit", geom::box_mesh({1, 1, 1}, {2, 2, 2}))};
    cdem::Simulation s(spec, threads, std::move(observer));
    if (rigid)
      s.make_rigid(cdem::Selection::everything());
    s.gravity(gravity());
    s.flow(in_water(wave, 1, 0.67));
    return s;
  };
  const auto solve = [](cdem::Simulation& s, int done) {
    cdem::RunOptions options;
    options.steps = 450;
    options.time_step = 1e-5;
    if (done == 0)
      s.run(options);
    return Figures{s.energy().total(), s.energy().external};
  };
  check_going_on(unit_in_waves, solve, {3, 14, 26});
}
