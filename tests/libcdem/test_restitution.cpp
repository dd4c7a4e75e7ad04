// Restitution of contacts: the speed after an impact over the speed before it, of rigid and deformable bodies.
#include "libgeom/mesh/box_mesh.hpp"
#include "libgeom/meshing/solid_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace testing;
using geom::Vec3;

namespace {

const double cube_side = 0.4, first_gap = 1e-4; // m
const double stiffness =
    2e9; // Pa/m of the contact: the cube has E / side = 1e11, so waves in it keep nothing
const double period =
    2 * pi * std::sqrt(2700 * cube_side / stiffness); // s, of the cube on its contact, at most

cdem::Joint bouncy(double restitution) {
  cdem::Joint joint;
  joint.bonded = false;
  joint.friction_angle = 30 * degree;
  joint.normal_stiffness = stiffness;
  joint.restitution = restitution;
  return joint;
}

geom::TetMesh box(const Vec3& size, const std::array<int, 3>& divisions, const Vec3& at) {
  geom::TetMesh mesh = geom::box_mesh(size, divisions);
  for (Vec3& x : mesh.nodes)
    x += at;
  return mesh;
}

// A cube over a held floor, with its corners anywhere over the floor's triangles.
cdem::Simulation cube_over_floor(const cdem::Joint& law, cdem::Element element, int divisions) {
  cdem::ModelSpec spec;
  spec.bodies = {meshed("floor", box({1, 1, 0.2}, {3, 3, 1}, {0, 0, -0.2})),
                 meshed("cube", box({cube_side, cube_side, cube_side}, {divisions, divisions, divisions},
                                    {0.313, 0.278, first_gap}))};
  spec.bodies[0].element = cdem::Element::rigid;
  spec.bodies[1].element = element;
  spec.default_contact = law;
  cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
  s.fix(fixed(cdem::Selection::of_body("floor")));
  return s;
}

double mean_velocity(const cdem::Simulation& s) {
  return s.mean("velocity.z", cdem::Selection::of_body("cube"));
}

} // namespace

TEST_CASE("bodies bounce with the restitution of their contact, rigid and deformable, on any mesh",
          "[contact]") {
  const auto bounced = [](cdem::Element element, int divisions, double restitution, double safety) {
    cdem::Simulation s = cube_over_floor(bouncy(restitution), element, divisions);
    s.initial_velocity(cdem::Selection::of_body("cube"), {0, 0, -1});
    cdem::RunOptions options;
    options.duration =
        2 * first_gap + 1.5 * period; // on a floor of larger triangles the contact is up to half as stiff
    options.safety = safety;
    s.run(options);
    return std::pair(mean_velocity(s), s.energy().balance_error());
  };
  // Waves close the contact of a deformable cube while the cube leaves it; what they press in so is given back.
  constexpr double of_impact = 0.012;
  for (const double restitution : {0.3, 0.6, 0.9})
    for (const int divisions : {1, 2, 3}) {
      INFO("restitution " << restitution << ", " << divisions << " cells a side");
      const auto [longest, longest_open] = bounced(cdem::Element::finite_volume, divisions, restitution, 0.9);
      CHECK(longest * longest == Approx(restitution * restitution).margin(of_impact));
      CHECK(longest_open < 2e-3);
      const auto [deformable, open] = bounced(cdem::Element::finite_volume, divisions, restitution, 0.4);
      CHECK(deformable * deformable == Approx(restitution * restitution).margin(of_impact));
      CHECK(open < 5e-4);
      // The whole impact of a rigid body is some twenty of its longest steps.
      const auto [coarse, coarse_open] = bounced(cdem::Element::rigid, divisions, restitution, 0.5);
      CHECK(coarse == Approx(restitution).epsilon(0.04));
      CHECK(coarse_open < 4e-3);
      const auto [rigid, rigid_open] = bounced(cdem::Element::rigid, divisions, restitution, 0.1);
      CHECK(rigid == Approx(restitution).epsilon(0.02));
      CHECK(rigid_open < 2e-4);
    }
}

// While it goes down as a whole, waves in it move its surface up and down, with and against the contact's force.
TEST_CASE("what restitution takes of a body that rings never comes back", "[contact][energy]") {
  for (const double restitution : {0.1, 0.5}) {
    INFO("restitution " << restitution);
    cdem::Joint law = bouncy(restitution);
    law.normal_stiffness.reset(); // as soft as the body
    cdem::Simulation s = cube_over_floor(law, cdem::Element::finite_volume, 3);
    s.initial_velocity(cdem::Selection::of_body("cube"), {0.5, 0, -2}, {3, 5, 1});
    cdem::RunOptions options;
    options.duration = 0.01;
    options.safety = 0.5;
    s.run(options);
    const cdem::EnergyLedger energy = s.energy();
    CHECK(energy.damping > 0.1 * energy.external);
    CHECK(cdem::impossible_energy(s.energy(), s.time(), s.log().one_way).part < 2e-3);
    CHECK(energy.balance_error() < 2e-3);
  }
}

TEST_CASE("a body comes to rest on a contact with restitution and presses with its weight", "[contact]") {
  cdem::Simulation s = cube_over_floor(bouncy(0.3), cdem::Element::rigid, 2);
  s.gravity(gravity());
  cdem::RunOptions options;
  options.duration = 100 * period;
  options.safety = 0.5;
  s.run(options);
  CHECK(std::abs(mean_velocity(s)) < 1e-5);
  CHECK(s.energy().balance_error() < 1e-2);
}

TEST_CASE("a deformable body at rest on a floor only loses energy, at any restitution and step",
          "[contact][energy]") {
  const double restitution = GENERATE(0.05, 0.3, 0.7, 1.0), safety = GENERATE(0.5, 0.9);
  CAPTURE(restitution, safety);
  cdem::Joint law = bouncy(restitution);
  law.normal_stiffness.reset();
  cdem::ModelSpec spec;
  spec.bodies = {meshed("floor", box({1, 1, 0.2}, {3, 3, 1}, {0, 0, -0.2})),
                 meshed("cube", box({cube_side, cube_side, cube_side}, {2, 2, 2}, {0.313, 0.278, 0}))};
  spec.bodies[0].element = cdem::Element::rigid;
  spec.default_contact = law;
  cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
  s.fix(fixed(cdem::Selection::of_body("floor")));
  s.gravity(gravity());
  cdem::RunOptions options;
  options.duration = 0.01;
  options.safety = safety;
  s.run(options);
  // The weight came on at once. What still moves may not grow.
  const auto moving = [&] { return s.energy().kinetic + s.energy().elastic + s.energy().springs; };
  double before = moving() - s.energy().external;
  for (int i = 0; i < 5; ++i) {
    s.run(options);
    const double now = moving() - s.energy().external;
    CHECK(now <= before + 1e-4 * s.energy().external);
    before = now;
  }
  CHECK(s.energy().kinetic < 1e-3 * s.energy().external);
  CHECK(cdem::impossible_energy(s.energy(), s.time(), s.log().one_way).part < 2e-2);
}

// Its facets come to lie on the plates one by one, and the nodes of a fine mesh vibrate as fast as the steps allow.
TEST_CASE("a disc that is pressed between plates gets no energy from its contacts", "[contact][energy]") {
  const double restitution = GENERATE(0.5, 1.0), turn = GENERATE(0, 7);
  CAPTURE(restitution, turn);
  const double radius = 0.025, thickness = 0.01; // m
  geom::MeshSize fine;
  fine.size = 0.004;
  const geom::Solid disc = geom::rotated(geom::cylinder({0, 0, 0}, {0, thickness, 0}, radius), {0, 1, 0},
                                         turn * degree, {0, 0, 0});
  geom::TetMesh mesh = geom::mesh_solid(disc, fine);
  double top = 0, bottom = 0;
  for (const Vec3& x : mesh.nodes) {
    top = std::max(top, x.z());
    bottom = std::min(bottom, x.z());
  }
  const auto plate = [&](double from) {
    return box({2 * radius, 2 * thickness, 0.005}, {1, 1, 1}, {-radius, -0.5 * thickness, from});
  };
  cdem::Joint law;
  law.bonded = false;
  law.friction_angle = 25 * degree;
  law.restitution = restitution;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("disc", std::move(mesh)), meshed("lower", plate(bottom - 0.005)),
                 meshed("upper", plate(top))};
  spec.bodies[1].element = spec.bodies[2].element = cdem::Element::rigid;
  spec.default_contact = law;
  cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
  s.fix(fixed(cdem::Selection::of_body("lower")));
  cdem::Fix moved;
  moved.on = cdem::Selection::of_body("upper");
  moved.velocity = Vec3(0, 0, -0.1);
  moved.amplitude = [](double time) { return std::min(1.0, time / 1e-3); };
  s.fix(moved);
  cdem::RunOptions options;
  options.duration = 1.6e-3;
  s.run(options);
  const cdem::EnergyLedger energy = s.energy();
  CHECK(cdem::impossible_energy(energy, s.time(), s.log().one_way).part < 1e-3);
  CHECK(energy.balance_error() < 1e-3);
  CHECK(energy.kinetic < 5e-3 * energy.elastic); // it is pressed slowly
}

// It stands on its lower edge for the most part, and waves press its contacts and let them go.
TEST_CASE("a deformable body below its friction stands on a steep slope", "[contact]") {
  const double friction = GENERATE(45, 60), restitution = GENERATE(0.05, 0.3, 0.7, 1.0),
               stiffness_damping = GENERATE(0, 1e-4), safety = GENERATE(0.3, 0.9);
  const bool relaxed = GENERATE(false, true);
  CAPTURE(friction, restitution, stiffness_damping, safety, relaxed);
  cdem::Joint law = bouncy(restitution);
  law.normal_stiffness.reset();
  law.friction_angle = friction * degree;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("floor", box({2, 2, 0.5}, {2, 2, 1}, {-1, -1, -0.5})),
                 meshed("cube", box({cube_side, cube_side, cube_side}, {2, 2, 2}, {-0.2, -0.2, 0}))};
  spec.bodies[0].element = cdem::Element::rigid;
  spec.bodies[1].material.stiffness_damping = stiffness_damping;
  spec.default_contact = law;
  cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
  s.fix(fixed(cdem::Selection::of_body("floor")));
  s.gravity(gravity({9.81 * std::sin(40 * degree), 0, -9.81 * std::cos(40 * degree)}));
  cdem::RunOptions options;
  options.safety = safety;
  if (relaxed) {
    cdem::RelaxOptions relaxation;
    relaxation.residual = 1e-8;
    s.relax(relaxation);
  } else { // the weight comes on at once
    options.duration = 0.05;
    s.run(options);
  }
  options.duration = 0.02;
  const double before = s.mean("displacement.x", cdem::Selection::of_body("cube"));
  s.run(options);
  CHECK(s.mean("displacement.x", cdem::Selection::of_body("cube")) - before < 2e-7);
  CHECK(s.energy().kinetic < 5e-3 * s.energy().external);
}

// With nothing but defaults: what vibrates in the contact dies, though an impact loses nothing.
TEST_CASE("a deformable block pulled below its friction stands, and above slides by the law", "[contact]") {
  const double part = GENERATE(0.99, 1.01); // of the friction
  const bool relaxed = GENERATE(false, true);
  CAPTURE(part, relaxed);
  cdem::Joint law;
  law.bonded = false;
  law.friction_angle = 31 * degree;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("plate", box({4, 4, 0.4}, {4, 4, 1}, {-2, -2, -0.4})),
                 meshed("block", box({1, 0.8, 0.2}, {4, 3, 1}, {-0.5, -0.4, 1e-5}))};
  for (cdem::BodySpec& body : spec.bodies) {
    body.material.youngs_modulus = 1e9;
    body.material.poissons_ratio = 0.2;
  }
  spec.default_contact = law;
  cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
  s.fix(fixed(cdem::Selection::of_body("plate")));
  s.gravity(gravity());
  if (relaxed)
    s.relax({});
  const double friction = std::tan(law.friction_angle), began = s.time(), loads = 0.2, holds = 0.3; // s
  cdem::Gravity pull = gravity();
  pull.turning = [=](double t) -> Vec3 {
    return {part * friction * 9.81 * std::min(1.0, (t - began) / loads), 0, -9.81};
  };
  s.gravity(pull);
  cdem::RunOptions options;
  options.duration = loads;
  s.run(options);
  const auto moved = [&] { return s.mean("displacement.x", cdem::Selection::of_body("block")); };
  const double before = moved();
  options.duration = holds;
  s.run(options);
  if (part < 1)
    CHECK(moved() - before < 2e-6);
  else
    CHECK(moved() - before ==
          Approx(0.5 * 0.01 * friction * 9.81 * holds * holds).epsilon(relaxed ? 0.03 : 0.06));
}

// Friction that follows each vibration of the normal force lets the plate slide 1.1 to 2.1 times as fast.
TEST_CASE("a thin deformable body slides as fast as its friction says", "[contact]") {
  const double friction = GENERATE(20, 30, 40, 45), slope = friction + 2, restitution = GENERATE(0.5, 1.0);
  const bool relaxed = GENERATE(false, true);
  CAPTURE(friction, restitution, relaxed);
  if (restitution == 1 && friction > 40)
    return; // it may go on bouncing
  cdem::Joint law = bouncy(restitution);
  law.normal_stiffness.reset();
  law.friction_angle = friction * degree;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("floor", box({6, 4, 0.5}, {3, 2, 1}, {-2, -2, -0.5})),
                 meshed("plate", box({1, 1, 0.25}, {2, 2, 1}, {-0.5, -0.45, 0}))};
  spec.bodies[0].element = cdem::Element::rigid;
  spec.default_contact = law;
  cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
  s.fix(fixed(cdem::Selection::of_body("floor")));
  s.gravity(gravity({9.81 * std::sin(slope * degree), 0, -9.81 * std::cos(slope * degree)}));
  if (relaxed) {
    cdem::RelaxOptions relaxation;
    relaxation.residual = 1e-6;
    relaxation.max_steps = 2000; // above its friction it never comes to rest
    s.relax(relaxation);
  }
  cdem::RunOptions options;
  options.duration = 0.05;
  s.run(options);
  const auto velocity = [&] { return s.mean("velocity.x", cdem::Selection::of_body("plate")); };
  const double before = velocity();
  s.run(options);
  CHECK((velocity() - before) / options.duration ==
        Approx(9.81 * (std::sin(slope * degree) - std::tan(friction * degree) * std::cos(slope * degree)))
            .epsilon(3e-3));
  const double mass = 0.25 * spec.bodies[1].material.density;
  CHECK(s.energy().kinetic ==
        Approx(0.5 * mass * velocity() * velocity()).epsilon(1e-3)); // it does not vibrate
}

TEST_CASE("a flat drop gives the force of the wave, rho c v A, on a rigid floor of any mesh", "[contact]") {
  // nu = 0: a bar. The floor is rigid, so its mesh may mean nothing.
  const int divisions = GENERATE(1, 3, 12);
  CAPTURE(divisions);
  const double speed = 0.1, side = 1;
  cdem::ModelSpec spec;
  spec.bodies = {meshed("floor", box({1.4, 1.4, 0.2}, {divisions, divisions, 1}, {-0.2, -0.2, -0.2})),
                 meshed("cube", box({side, side, side}, {4, 4, 4}, {0, 0, 1e-5}))};
  spec.bodies[0].element = cdem::Element::rigid;
  spec.bodies[1].material.poissons_ratio = 0;
  cdem::Joint law;
  law.bonded = false;
  law.friction_angle = 0;
  spec.default_contact = law;
  cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
  s.fix(fixed(cdem::Selection::of_body("floor")));
  s.initial_velocity(cdem::Selection::of_body("cube"), {0, 0, -speed});
  const cdem::Elastic& stone = spec.bodies[1].material;
  const double c = std::sqrt(stone.youngs_modulus / stone.density),
               wave = stone.density * c * speed * side * side;
  double largest = 0, last = 0;
  for (int i = 0; i < 60; ++i) {
    cdem::RunOptions options;
    options.duration = 0.05 * 2 * side / c;
    s.run(options);
    const double force = std::abs(s.reaction(cdem::Selection::of_body("floor")).z());
    largest = std::max(largest, force);
    if (force > 1e-2 * wave)
      last = s.time();
  }
  CHECK(largest == Approx(1.04 * wave).epsilon(0.04)); // a mesh of four cells rings
  CHECK((last - 1e-5 / speed) / (2 * side / c) == Approx(1.15).epsilon(0.1));
}
