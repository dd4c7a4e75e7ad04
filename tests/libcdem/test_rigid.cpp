// Rigid bodies: Newton and Euler by central differences, and the way from rigid to deformable and back.
#include "libcdem/element/rigid_motion.hpp"
#include "libcdem/model/build/rigid_bodies.hpp"
#include "libcdem/procedure/turn_rigid.hpp"
#include "libcdem/results/energy.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/random.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

const Vec3 sides(1, 0.6, 0.3); // m

cdem::BodySpec rigid(std::string name, const Vec3& size, const Vec3& at = Vec3::Zero(),
                     std::array<int, 3> divisions = {4, 3, 2}) {
  geom::TetMesh mesh = geom::box_mesh(size, divisions);
  for (Vec3& x : mesh.nodes)
    x += at;
  cdem::BodySpec body = meshed(std::move(name), std::move(mesh));
  body.element = cdem::Element::rigid;
  return body;
}

System one_box(const Vec3& at = Vec3::Zero()) {
  return System(build({rigid("unit", sides, at)}));
}

cdem::RunOptions steps_of(double time_step, std::int64_t steps) {
  cdem::RunOptions options;
  options.time_step = time_step;
  options.steps = steps;
  return options;
}

Mat3 rotation_of(const System& s) {
  return cdem::rotation(s.state.rigid[0]);
}

// In the directions of the principal axes.
Vec3 body_spin(const System& s) {
  const cdem::RigidBody& body = s.model.rigid[0];
  return body.axes.transpose() * rotation_of(s).transpose() * cdem::spin(body, s.state.rigid[0], 0);
}

void set_spin(System& s, const Vec3& principal) {
  const cdem::RigidBody& body = s.model.rigid[0];
  s.state.rigid[0].angular_momentum = cdem::three_of(rotation_of(s) * body.inertia * body.axes * principal);
  cdem::place_nodes(s.model, s.state, 0);
}

Momentum of_nodes(const System& s) {
  return momentum(s, Places::present);
}

Momentum of_body(const System& s) {
  const cdem::RigidState& r = s.state.rigid[0];
  Momentum m;
  m.linear = s.model.rigid[0].mass * cdem::vec(r.velocity);
  m.angular = cdem::vec(r.angular_momentum) + cdem::vec(r.centroid).cross(m.linear);
  return m;
}

} // namespace

TEST_CASE(
    "a rigid box has the solid's mass, centroid and inertia on any mesh, and its nodes come near it with h^2",
    "[rigid]") {
  const double mass = rock().density * sides.prod();
  const auto error = [&](int n) { // of the masses at the nodes
    const cdem::Model model = build({rigid("unit", sides, {3, -2, 1}, {n, n, n})});
    const cdem::RigidShape shape = cdem::rigid_shape(model, 0);
    CHECK(shape.body.mass == Approx(mass).epsilon(1e-12));
    CHECK((shape.centroid - Vec3(3, -2, 1) - 0.5 * sides).norm() < 1e-12);
    const Vec3 square = sides.cwiseProduct(sides);
    const Mat3 solid = mass / 12 * (Mat3(square.sum() * Mat3::Identity()) - Mat3(square.asDiagonal()));
    CHECK((shape.body.inertia - solid).norm() < 1e-12 * solid.norm());
    return (shape.nodal_inertia - solid).norm() / solid.norm();
  };
  const double coarse = error(4), fine = error(8);
  INFO("errors " << coarse << " and " << fine);
  CHECK(coarse / fine == Approx(4).epsilon(1e-9));
  CHECK(fine < 0.05);
}

TEST_CASE("a rigid body falls g t^2 / 2 exactly, turning or not", "[rigid][run]") {
  System s = one_box();
  const Vec3 g(0.3, -0.5, -9.81), v0(1, 2, 3);
  s.conditions.gravity = cdem::Gravity{g, 0, {}};
  s.state.rigid[0].velocity = cdem::three_of(v0);
  set_spin(s, GENERATE(Vec3(0, 0, 0), Vec3(3, 1, 2)));
  s.run(steps_of(1e-3, 1));
  s.run(steps_of(2e-3, 499));
  const double t = s.state.time;
  const Vec3 way = v0 * t + 0.5 * t * t * g;
  CHECK((cdem::vec(s.state.rigid[0].centroid) - 0.5 * sides - way).norm() < 1e-12 * way.norm());
  const cdem::EnergyLedger e = cdem::energy(s.model, s.state);
  const double mass = s.model.rigid[0].mass, half = t - s.state.velocity_lag;
  const Vec3 fallen = v0 * half + 0.5 * half * half * g;
  CHECK(e.external == Approx(mass * g.dot(fallen)).epsilon(1e-10));
}

TEST_CASE("displacements of a rigid body grow by velocity times time step, and its shape stays", "[rigid]") {
  System s = one_box({10, 5, -3});
  s.state.rigid[0].velocity = {1, -2, 0.5};
  set_spin(s, {5, 3, 4});
  s.run(steps_of(1e-2, 100));
  const std::vector<cdem::Node> before = s.state.displacement;
  s.run(steps_of(1e-2, 1));
  for (std::size_t i = 0; i < before.size(); ++i)
    CHECK((vec(s.state.displacement[i]) - vec(before[i]) - 1e-2 * vec(s.state.velocity[i])).norm() < 1e-13);
  const auto place = [&](std::size_t i) -> Vec3 {
    return s.model.node_position[i] + vec(s.state.displacement[i]);
  };
  for (std::size_t i = 1; i < before.size(); ++i)
    CHECK((place(i) - place(0)).norm() ==
          Approx((s.model.node_position[i] - s.model.node_position[0]).norm()).epsilon(1e-12));
}

TEST_CASE("a box spinning about its middle axis tumbles with Euler's period", "[rigid]") {
  // Landau and Lifshitz, Mechanics, section 37: for L^2 > 2 E I2 the period in the body is 4 K(k) / p.
  const Vec3 spin0(0, 2, 0.05); // rad/s
  const auto errors = [&](int steps) {
    System s = one_box();
    const Vec3 moment = s.model.rigid[0].principal;
    set_spin(s, spin0);
    const double l2 = moment.cwiseProduct(spin0).squaredNorm();
    const double e2 = moment.dot(spin0.cwiseProduct(spin0));
    const double p = std::sqrt((moment[2] - moment[1]) * (l2 - e2 * moment[0]) / moment.prod());
    const double k2 =
        (moment[1] - moment[0]) * (e2 * moment[2] - l2) / ((moment[2] - moment[1]) * (l2 - e2 * moment[0]));
    const double period = 4 * std::comp_ellint_1(std::sqrt(k2)) / p;
    const auto momentum = s.state.rigid[0].angular_momentum;
    double energy_error = 0;
    cdem::RunOptions options = steps_of(period / steps, steps / 2);
    options.callback_every = 1;
    options.callback = [&] {
      const double now = 2 * cdem::energy(s.model, s.state).kinetic;
      energy_error = std::max(energy_error, std::abs(now / e2 - 1));
    };
    s.run(options);
    const Vec3 half = body_spin(s);
    s.run(options);
    CHECK((cdem::vec(s.state.rigid[0].angular_momentum) - cdem::vec(momentum)).norm() <=
          1e-12 * cdem::vec(momentum).norm());
    // Half a period later the middle spin has turned round, after a whole one all is as it was.
    const Vec3 reversed(0, -spin0[1], spin0[2]);
    return std::array<double, 3>{(half - reversed).norm() / spin0.norm(),
                                 (body_spin(s) - spin0).norm() / spin0.norm(), energy_error};
  };
  const auto coarse = errors(2000), fine = errors(4000);
  for (int i = 0; i < 3; ++i) {
    INFO("errors " << coarse[i] << " and " << fine[i]);
    CHECK(coarse[i] / fine[i] == Approx(4).epsilon(0.1));
    CHECK(fine[i] < 1e-3);
  }
}

TEST_CASE("a couple gives a rigid body the angular acceleration I^-1 tau and no push", "[rigid]") {
  System s = one_box({-4, 2, 1});
  const double shear = 1e3; // Pa
  s.conditions.tractions.push_back(traction(cdem::Selection::side("x+"), {0, shear, 0}));
  s.conditions.tractions.push_back(traction(cdem::Selection::side("x-"), {0, -shear, 0}));
  const Vec3 square = sides.cwiseProduct(sides);
  const Mat3 inertia = rock().density * sides.prod() / 12 *
                       (Mat3(square.sum() * Mat3::Identity()) - Mat3(square.asDiagonal()));
  const Vec3 torque(0, 0, shear * sides.prod()); // force on a side times the distance of the two
  s.run(steps_of(1e-6, 200));
  const double t = s.state.time - s.state.velocity_lag;
  const Vec3 spin = cdem::spin(s.model.rigid[0], s.state.rigid[0], -s.state.velocity_lag);
  CHECK((spin - t * inertia.inverse() * torque).norm() < 1e-8 * spin.norm());
  CHECK(cdem::vec(s.state.rigid[0].velocity).norm() < 1e-12 * spin.norm());
  const double kinetic = 0.5 * torque.dot(inertia.inverse() * torque) * t * t;
  CHECK(cdem::energy(s.model, s.state).external == Approx(kinetic).epsilon(1e-6));
}

TEST_CASE("local damping slows a pushed rigid body by its part and never speeds it up", "[rigid][damping]") {
  System s = one_box();
  s.conditions.gravity = cdem::Gravity{{0, 0, -10}, 0, {}};
  cdem::RunOptions options = steps_of(1e-3, 1000);
  options.local_damping = 0.4;
  s.run(options);
  const double t = s.state.time - s.state.velocity_lag;
  CHECK(s.state.rigid[0].velocity[2] == Approx(-6 * t).epsilon(1e-12));
  CHECK(cdem::energy(s.model, s.state).balance_error() < 1e-12);
  // Turned round by the force within the steps, it loses energy in every one of them.
  s.conditions.gravity = cdem::Gravity{{0, 0, 1e5}, 0, {}};
  double before = s.state.spent.damping;
  options.steps = 1;
  for (int i = 0; i < 20; ++i) {
    s.run(options);
    CHECK(s.state.spent.damping >= before);
    before = s.state.spent.damping;
  }
}

TEST_CASE(
    "rigid, deformable and rigid again keeps momentum and spin: the angular momentum of the masses that turn",
    "[rigid][momentum]") {
  System s = one_box({2, 3, -1});
  s.state.rigid[0].velocity = {4, -2, 1};
  set_spin(s, {3, 2, 4});
  s.run(steps_of(1e-3, 300));
  const Momentum as_solid = of_body(s);
  const cdem::RigidState body = s.state.rigid[0];
  const Mat3 turned = cdem::rotation(body);
  const Vec3 at = cdem::vec(body.centroid), w = cdem::spin(s.model.rigid[0], body, 0);
  // With the masses at the nodes, in the same motion.
  const Mat3 nodal = turned * cdem::rigid_shape(s.model, 0).nodal_inertia * turned.transpose();
  Momentum start = as_solid;
  start.angular = nodal * w + at.cross(as_solid.linear);
  const auto drift = [](const Momentum& now, const Momentum& then) {
    return std::max((now.linear - then.linear).norm() / then.linear.norm(),
                    (now.angular - then.angular).norm() / then.angular.norm());
  };
  CHECK(cdem::set_deformable(s.model, s.state, {0}) == 1);
  CHECK(s.model.rigid.empty());
  CHECK(drift(of_nodes(s), start) < 1e-12);
  cdem::RunOptions options;
  options.steps = 200;
  s.run(options);
  CHECK(cdem::set_rigid(s.model, s.state, {0}) == 1);
  CHECK(drift(of_nodes(s), start) < 1e-3); // the same up to the chord of a turn
  // The solid has the spin of the nodes: its angular momentum about its centroid is smaller.
  const cdem::RigidShape shape = cdem::rigid_shape(s.model, 0, s.state.displacement.data());
  const cdem::RigidState again = s.state.rigid[0];
  CHECK((of_body(s).linear - start.linear).norm() < 1e-12 * start.linear.norm());
  const Vec3 about_centroid = start.angular - cdem::vec(again.centroid).cross(start.linear),
             expected = shape.body.inertia * shape.nodal_inertia.inverse() * about_centroid;
  CHECK((cdem::vec(again.angular_momentum) - expected).norm() < 1e-12 * start.angular.norm());
}

TEST_CASE("turning deformable and rigid keeps the energy balance, and loses only energy of deformation",
          "[rigid][energy]") {
  System s = one_box();
  set_spin(s, {3, 2, 4});
  s.state.spent.external = cdem::energy(s.model, s.state).kinetic; // given with the spin
  s.state.spent.external_peak = s.state.spent.external;
  s.run(steps_of(1e-6, 100));
  const double kinetic = cdem::energy(s.model, s.state).kinetic;
  const Vec3 w =
      cdem::rotation(s.state.rigid[0]).transpose() * cdem::spin(s.model.rigid[0], s.state.rigid[0], 0);
  const double of_nodes = 0.5 * w.dot(cdem::rigid_shape(s.model, 0).nodal_inertia * w);
  cdem::set_deformable(s.model, s.state, {0});
  CHECK(s.state.spent.fictitious == Approx(kinetic - of_nodes).epsilon(1e-4)); // of half a step's turn
  const double still = cdem::energy(s.model, s.state).total();
  for (std::size_t i = 0; i < s.state.velocity.size(); ++i) { // shaken
    s.state.velocity[i].x += geom::uniform(5, i, 0) - 0.5;
    s.state.velocity[i].y += geom::uniform(5, i, 1) - 0.5;
    s.state.velocity[i].z += geom::uniform(5, i, 2) - 0.5;
  }
  s.state.spent.external += cdem::energy(s.model, s.state).total() - still;
  cdem::RunOptions options;
  options.steps = 100;
  options.safety = 0.25;
  s.run(options);
  const double before = s.state.spent.fictitious;
  cdem::set_rigid(s.model, s.state, {0});
  CHECK(s.state.spent.fictitious > before);
  CHECK(cdem::energy(s.model, s.state).balance_error() < 1e-3);
}

TEST_CASE("stress frozen in a rigid body turns with it", "[rigid][spin]") {
  cdem::BodySpec spec = meshed("unit", geom::box_mesh(sides, {2, 2, 2}));
  System s(build({spec}));
  const Mat3 stress = symmetric(3e6, -2e6, 1e6, 5e5, -4e5, 7e5);
  const cdem::Stress components{stress(0, 0), stress(1, 1), stress(2, 2),
                                stress(0, 1), stress(1, 2), stress(0, 2)};
  for (cdem::StressBatch& batch : s.state.stress)
    for (int c = 0; c < 6; ++c)
      for (double& lane : batch.component[c])
        lane = components[c];
  const double elastic = cdem::energy(s.model, s.state).elastic;
  cdem::set_rigid(s.model, s.state, {0});
  CHECK(s.state.spent.fictitious == 0);
  // A given turn: straight to it.
  cdem::turn_by(s.state.rigid[0], 0.7 * Vec3(1, 2, -0.5).normalized());
  cdem::place_nodes(s.model, s.state, 0);
  const Mat3 r = rotation(Vec3(1, 2, -0.5).normalized(), 0.7);
  const auto error = [&] {
    double most = 0;
    for (int t = 0; t < static_cast<int>(s.model.tets.size()); ++t)
      most = std::max(most, (tet_stress(s, t) - r * stress * r.transpose()).norm() / stress.norm());
    return most;
  };
  CHECK(error() < 1e-12);
  CHECK(cdem::energy(s.model, s.state).elastic == Approx(elastic).epsilon(1e-12));
  cdem::set_deformable(s.model, s.state, {0});
  CHECK(error() < 1e-12);
  CHECK(cdem::energy(s.model, s.state).elastic == Approx(elastic).epsilon(1e-12));
}

TEST_CASE("a rigid spin goes on when the body may deform, with no stress but that of the spin",
          "[rigid][spin]") {
  System s = one_box();
  const double spin = 1; // rad/s, about the stiffest axis, which it keeps
  set_spin(s, {0, 0, spin});
  s.run(steps_of(1e-4, 1000));
  cdem::set_deformable(s.model, s.state, {0});
  const Momentum before = of_nodes(s);
  cdem::RunOptions options;
  options.steps = 5000;
  s.run(options);
  CHECK((of_nodes(s).angular - before.angular).norm() < 1e-12 * before.angular.norm());
  // rho w^2 r^2 of a body that starts to be pulled all at once, twice that at rest; of corners, in coarse tets.
  const double most = 4 * rock().density * spin * spin * sides.squaredNorm();
  for (int t = 0; t < static_cast<int>(s.model.tets.size()); ++t)
    CHECK(tet_stress(s, t).norm() < most);
  CHECK(most < 1e-6 * rock().youngs_modulus);
}

TEST_CASE("a held rigid body stays, is moved as asked, and gives its reaction", "[rigid][held]") {
  System s = one_box();
  s.conditions.gravity = cdem::Gravity{{0, 0, -10}, 0, {}};
  s.hold(cdem::Selection::side("z-"), "xyz");
  s.run(steps_of(1e-3, 100));
  for (const cdem::Node& u : s.state.displacement)
    CHECK(vec(u).norm() == 0);
  CHECK(s.relax(1e-6).converged);
  s.conditions.fixes.back().velocity = Vec3(0.1, 0, -0.2);
  const double start = s.state.time;
  s.run(steps_of(1e-3, 100));
  const Vec3 way = (s.state.time - start) * Vec3(0.1, 0, -0.2);
  for (const cdem::Node& u : s.state.displacement)
    CHECK((vec(u) - way).norm() < 1e-12);
  CHECK(cdem::energy(s.model, s.state).balance_error() < 1e-12);
}

TEST_CASE("what a rigid body cannot do is refused", "[rigid][input]") {
  System s = one_box();
  cdem::RunOptions no_time_step;
  no_time_step.steps = 10;
  CHECK_THROWS_WITH(s.run(no_time_step), Catch::Contains("time_step: missing"));
  CHECK_THROWS_WITH(s.relax(1e-6), Catch::Contains("\"unit\" is rigid and free"));
  s.hold(cdem::Selection::side("z-"), "z");
  CHECK_THROWS_WITH(s.run(steps_of(1e-3, 1)), Catch::Contains("held in some axes only"));
  s.conditions.fixes.back().axes = {true, true, true};
  s.conditions.fixes.back().displacement = Vec3(0, 0, 1);
  CHECK_THROWS_WITH(s.run(steps_of(1e-3, 1)), Catch::Contains("at a given displacement"));
  s.conditions.fixes.back().displacement.reset();
  s.hold(cdem::Selection::side("z+"), "xyz");
  s.conditions.fixes.back().velocity = Vec3(0, 0, 1);
  CHECK_THROWS_WITH(s.run(steps_of(1e-3, 1)), Catch::Contains("several velocities"));
}

TEST_CASE("a step that turns a rigid body too far names it", "[rigid][input]") {
  System s = one_box();
  set_spin(s, {0, 0, 10});
  CHECK_THROWS_WITH(s.run(steps_of(0.2, 5)), Catch::Contains("turns by a radian or more in a step") &&
                                                 Catch::Contains("body \"unit\""));
}

TEST_CASE("rigid bodies move with the same bits on 1, 2 and 4 threads", "[rigid][hash]") {
  std::vector<cdem::BodySpec> bodies;
  cdem::BodySpec units = rigid("units", {0.1, 0.12, 0.15}, {0, 0, 0}, {1, 1, 1});
  const geom::TetMesh mesh = units.meshes[0];
  for (int i = 1; i < 160; ++i) {
    units.meshes.push_back(mesh);
    for (Vec3& x : units.meshes.back().nodes)
      x += Vec3(0.5 * i, 0, 0); // they never meet
  }
  System first(build({units}));
  first.conditions.gravity = cdem::Gravity{{0, 0, -9.81}, 0, {}};
  for (std::size_t i = 0; i < first.state.rigid.size(); ++i)
    first.state.rigid[i].angular_momentum = {geom::uniform(1, i, 0), geom::uniform(1, i, 1),
                                             geom::uniform(1, i, 2)};
  std::uint64_t expected = 0;
  for (const int threads : {1, 2, 4}) {
    System s = first;
    s.threads = threads;
    s.run(steps_of(1e-3, 50));
    if (threads == 1)
      expected = cdem::hash(s.state);
    CHECK(cdem::hash(s.state) == expected);
  }
  CHECK(expected != cdem::hash(first.state));
}
