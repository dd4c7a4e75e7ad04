// Impacts of rigid bodies at the step that a run takes by default: what they keep of their energy. The error of a step dt is
// (omega dt)^4 of the energy with e = 1 (docs/contact.md, section 7).
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/system.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace testing;
using geom::Vec3;

namespace {

cdem::Joint bouncy(double restitution) {
  cdem::Joint joint;
  joint.bonded = false;
  joint.friction_angle = 0;
  joint.restitution = restitution;
  return joint;
}

geom::TetMesh cube(double side, int divisions) {
  geom::TetMesh mesh = geom::box_mesh({side, side, side}, {divisions, divisions, divisions});
  for (Vec3& x : mesh.nodes)
    x -= Vec3::Constant(side / 2);
  return mesh;
}

// A cube whose nodes are moved along their rays until its surface is a sphere's.
geom::TetMesh ball(double radius, int divisions) {
  geom::TetMesh mesh = cube(2 * radius, divisions);
  for (Vec3& x : mesh.nodes)
    if (x.norm() > 0)
      x *= x.cwiseAbs().maxCoeff() / x.norm();
  return mesh;
}

geom::TetMesh turned(geom::TetMesh mesh, const geom::Mat3& rotation, const Vec3& at) {
  for (Vec3& x : mesh.nodes)
    x = rotation * x + at;
  return mesh;
}

struct Impact {
  double energy = 0;      // kinetic after over kinetic before
  double ledger = 0;      // error of the balance
  double restitution = 0; // relative speed of the centroids after over before
};

// Two rigid bodies, the second of which flies at the first at `speed` (m/s) over a gap of some of their steps.
Impact meet(const geom::TetMesh& one, const geom::TetMesh& other, const Vec3& direction, double speed,
            double restitution) {
  cdem::ModelSpec spec;
  spec.bodies = {meshed("one", one), meshed("other", other)};
  for (cdem::BodySpec& body : spec.bodies)
    body.element = cdem::Element::rigid;
  spec.default_contact = bouncy(restitution);
  cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
  s.initial_velocity(cdem::Selection::of_body("other"), speed * direction);
  const double before = s.energy().kinetic;
  const auto apart = [&] {
    return direction.dot(Vec3(s.mean("velocity.x", cdem::Selection::of_body("other")),
                              s.mean("velocity.y", cdem::Selection::of_body("other")),
                              s.mean("velocity.z", cdem::Selection::of_body("other"))) -
                         Vec3(s.mean("velocity.x", cdem::Selection::of_body("one")),
                              s.mean("velocity.y", cdem::Selection::of_body("one")),
                              s.mean("velocity.z", cdem::Selection::of_body("one"))));
  };
  cdem::RunOptions options;
  options.duration = 0.03 + 1e-4 / speed; // s; the slowest impact, on a corner, takes less than 0.03 s
  s.run(options);
  CHECK(s.energy().springs < 1e-9 * before); // they have parted
  return {s.energy().kinetic / before, s.energy().balance_error(), -apart() / speed};
}

const geom::Mat3 oblique =
    Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).toRotationMatrix(); // no axis is special

} // namespace

TEST_CASE("rigid bodies keep their energy in an impact at the default step, whatever meets and how fast",
          "[contact]") {
  const double gap = 3e-5; // m
  const Vec3 z = Vec3::UnitZ();
  // A cube on a corner: its diagonal along z.
  const geom::Mat3 on_corner =
      Eigen::Quaterniond::FromTwoVectors(Vec3(1, 1, 1).normalized(), z).toRotationMatrix();
  for (const double speed : {0.03, 0.5, 3.})
    for (const double part : {0.1, 0.45, 0.8}) { // the gap in other parts of a step
      const double start = gap * (1 + part);
      INFO(speed << " m/s, gap " << start << " m");
      const auto check = [&](const char* what, const geom::TetMesh& one, const geom::TetMesh& other,
                             bool central) {
        INFO(what);
        const Vec3 direction = oblique * z;
        const geom::TetMesh first = turned(one, oblique, Vec3::Zero()),
                            second = turned(other, oblique, Vec3::Zero());
        const Impact elastic = meet(first, second, -direction, speed, 1);
        CHECK(elastic.energy == Approx(1).epsilon(0.01));
        CHECK(elastic.ledger < 0.01);
        if (central)
          CHECK(elastic.restitution == Approx(1).epsilon(0.01));
        const Impact half = meet(first, second, -direction, speed, 0.5);
        CHECK(half.ledger < 0.01);
        if (central)
          CHECK(half.restitution == Approx(0.5).epsilon(0.03));
      };
      check("cubes", cube(0.4, 2), turned(cube(0.4, 2), geom::Mat3::Identity(), (0.4 + start) * z), true);
      check("balls", ball(0.2, 4), turned(ball(0.2, 4), geom::Mat3::Identity(), (0.4 + start) * z), false);
      check("corner on face", cube(0.4, 2),
            turned(cube(0.4, 2), on_corner, (0.2 + 0.2 * std::sqrt(3.) + start) * z + Vec3(0.03, 0.02, 0)),
            false);
    }
}

TEST_CASE(
    "the steps of rigid bodies follow the stiffness that their law gives, and impacts keep their energy",
    "[contact]") {
  const double side = 0.4, speed = 0.5, height = 0.01; // m, m/s, m
  const auto bounced = [&](double stiffness, double modulus, double gap) {
    cdem::ModelSpec spec;
    spec.bodies = {
        meshed("floor", turned(cube(1, 2), geom::Mat3::Identity(), -0.5 * Vec3::UnitZ())),
        meshed("cube", turned(cube(side, 2), geom::Mat3::Identity(), (side / 2 + gap) * Vec3::UnitZ()))};
    for (cdem::BodySpec& body : spec.bodies) {
      body.element = cdem::Element::rigid;
      body.material.youngs_modulus = modulus;
    }
    spec.default_contact = bouncy(1);
    spec.default_contact->normal_stiffness = stiffness;
    cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
    s.fix(fixed(cdem::Selection::of_body("floor")));
    s.initial_velocity(cdem::Selection::of_body("cube"), {0, 0, -speed});
    const double before = s.energy().kinetic;
    cdem::RunOptions options;
    options.duration = 0.2; // s; the impact on the softest contact takes half of it
    s.run(options);
    CHECK(s.mean("velocity.z", cdem::Selection::of_body("cube")) > 0);
    CHECK(s.energy().kinetic == Approx(before).epsilon(std::pow(0.2, 4)));
    return s.steps();
  };
  const auto steps = [&](double stiffness, double modulus) { return bounced(stiffness, modulus, height); };
  const auto soft = steps(1e7, 3e10);
  CHECK(soft == steps(1e7, 1e9)); // the material is stiffer, and does not deform
  CHECK(static_cast<double>(steps(1e9, 3e10)) / static_cast<double>(soft) == Approx(10).epsilon(0.02));
  for (const double part : {0.1, 0.3, 0.5, 0.7, 0.9}) // of a step of 0.5 mm or so
    bounced(1e8, 3e10, height + 5e-4 * part);
}

TEST_CASE("a rigid body is set down in steps of at most half the stable one of its face", "[contact]") {
  const double stiffness = 1e8, side = 0.4, damping = GENERATE(0, 0.6);
  CAPTURE(damping);
  cdem::ModelSpec spec;
  spec.bodies = {
      meshed("floor", turned(cube(1, 2), geom::Mat3::Identity(), -0.5 * Vec3::UnitZ())),
      meshed("cube", turned(cube(side, 2), geom::Mat3::Identity(), (side / 2 + 1e-6) * Vec3::UnitZ()))};
  for (cdem::BodySpec& body : spec.bodies)
    body.element = cdem::Element::rigid;
  spec.default_contact = bouncy(1);
  spec.default_contact->normal_stiffness = stiffness;
  cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
  s.fix(fixed(cdem::Selection::of_body("floor")));
  s.gravity(gravity());
  cdem::RunOptions options;
  options.local_damping = damping;
  options.steps = 1;
  const double omega = std::sqrt(stiffness / (spec.bodies[1].material.density * side)); // on a held floor
  CHECK(s.run(options).time_step <= 0.5 * 2 / (std::sqrt(2.0) * omega));
  options.steps = 0;
  options.duration = 0.05;
  s.run(options);
  CHECK(s.energy().balance_error() < 5e-3);
}

TEST_CASE("a rigid body that lies on another one takes no smaller steps for impacts", "[contact]") {
  cdem::ModelSpec spec;
  spec.bodies = {meshed("floor", turned(cube(1, 2), geom::Mat3::Identity(), -0.5 * Vec3::UnitZ())),
                 meshed("cube", turned(cube(0.4, 2), geom::Mat3::Identity(), 0.2 * Vec3::UnitZ()))};
  for (cdem::BodySpec& body : spec.bodies)
    body.element = cdem::Element::rigid;
  spec.default_contact = bouncy(1);
  const auto step = [&](double height) {
    for (Vec3& x : spec.bodies[1].meshes[0].nodes)
      x.z() += height;
    cdem::Simulation s(spec, 1, std::make_shared<cdem::Observer>());
    s.fix(fixed(cdem::Selection::of_body("floor")));
    s.gravity(gravity());
    cdem::RunOptions options;
    options.duration = 0.02;
    return s.run(options).time_step;
  };
  const double resting = step(0), falling = step(1e-3);
  CHECK(resting > 2 * falling);
}
