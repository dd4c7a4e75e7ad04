// Laws of joints in models: sheared blocks, small strain and moving, by joint set.
#include "libcdem/results/units.hpp"
#include "tests/libcdem/going_on.hpp"

#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/mesh/box_mesh.hpp"

using namespace testing;
using Catch::Matchers::Contains;
using geom::Vec3;

namespace {

constexpr double pressure = 1e6; // Pa
const cdem::Selection top = cdem::Selection::side("z+"), bottom = cdem::Selection::side("z-");

// A flat block of 1 x 1 x 0.05 m on a thicker one, with this law on the face between them: thin, since what shears its top
// also turns it.
cdem::ModelSpec shear_box(const cdem::Joint& joint, cdem::Element element) {
  cdem::BodySpec body;
  body.name = "rock";
  geom::PlaneCutOptions options;
  options.name = "joint";
  body.shape = geom::cut_by_plane(geom::grid({1, 1, 0.25}, {1, 1, 1}),
                                  geom::Plane::through({0, 0, 0.2}, {0, 0, 1}), options);
  body.material = rock();
  body.material.youngs_modulus = 1e9; // large steps
  body.material.poissons_ratio = 0;
  body.joint = rock_joint();
  body.set_joints["joint"] = joint;
  body.element = element;
  cdem::ModelSpec spec;
  spec.bodies = {body};
  return spec;
}

cdem::Joint loose(const cdem::JointLaw& law, double friction = 30 * degree) {
  cdem::Joint joint;
  joint.bonded = false;
  joint.friction_angle = friction;
  joint.law = law;
  return joint;
}

cdem::ResidualStrength dilating(double limit = 1) {
  cdem::ResidualStrength law;
  law.friction = std::tan(25 * degree);
  law.dilation = std::tan(10 * degree);
  law.dilation_limit = limit;
  return law;
}

cdem::BartonBandis rough() {
  cdem::BartonBandis law;
  law.jrc = 10;
  law.jcs = 100e6;
  law.residual_angle = 28 * degree;
  law.initial_stiffness = 2e9;
  law.maximum_closure = 1e-3;
  law.peak_slip = 2e-3;
  return law;
}

void press(cdem::Simulation& s) {
  s.fix(fixed(bottom));
  s.fix(fixed(top, "y"));
  s.traction(traction(top, {0, 0, -pressure}));
}

void shear_to(cdem::Simulation& s, double slip) {
  cdem::Fix fix = fixed(top, "x");
  fix.displacement = Vec3(slip, 0, 0);
  s.fix(fix);
  cdem::RelaxOptions options;
  options.residual = 1e-7;
  REQUIRE(s.relax(options).converged);
}

// On by this much, slowly and damped, so that the joint slides at the end.
void slide_by(cdem::Simulation& s, double slip) {
  s.release(top, axes("x"));
  cdem::Fix move = fixed(top, "x");
  move.velocity = Vec3(0.02, 0, 0);
  s.fix(move);
  cdem::RunOptions options;
  options.duration = slip / 0.02;
  options.local_damping = 0.3;
  s.run(options);
}

cdem::JointSum sum_of(const cdem::Simulation& s) {
  return s.joints({{"joint"}, {}}).at(0);
}

const auto elements = {cdem::Element::small_strain, cdem::Element::finite_volume};

} // namespace

TEST_CASE("a joint set with dilation opens by slip up to its limit and slides at its residual friction",
          "[joint_laws]") {
  const auto element = GENERATE(from_range(elements));
  const double limit = 2e-3;
  cdem::Simulation s(shear_box(loose(dilating(limit)), element), 1, nullptr);
  press(s);
  shear_to(s, 0);
  const double z = s.mean("displacement.z", top);
  slide_by(s, 2e-3);
  const cdem::JointSum sliding = sum_of(s);
  CHECK(s.reaction(top).x() == Approx(pressure * std::tan(25 * degree)).epsilon(0.01));
  CHECK(sliding.shear == Approx(pressure * std::tan(25 * degree)).epsilon(0.01));
  CHECK(sliding.normal == Approx(-pressure).epsilon(0.01));
  CHECK(sliding.mean_utilisation == Approx(1).epsilon(1e-6));
  slide_by(s, 3e-3);
  CHECK(s.mean("displacement.z", top) - z == Approx(limit * std::tan(10 * degree)).epsilon(0.03));
}

TEST_CASE("a Barton-Bandis joint closes on its hyperbola and peaks at its mobilised roughness",
          "[joint_laws][barton_bandis]") {
  const auto element = GENERATE(from_range(elements));
  cdem::Joint joint = loose(rough());
  joint.normal_stiffness = joint.shear_stiffness = 1e11;
  cdem::Simulation s(shear_box(joint, element), 1, nullptr);
  press(s);
  shear_to(s, 0);
  CHECK(sum_of(s).mean_opening == Approx(-pressure / (2e9 + pressure / 1e-3)).epsilon(2e-3));
  double peak = 0;
  for (int i = 0; i < 80; ++i) {
    slide_by(s, 0.05e-3);
    peak = std::max(peak, s.reaction(top).x());
  }
  CHECK(peak == Approx(pressure * std::tan(rough().friction_angle(pressure, 2e-3))).epsilon(0.02));
  CHECK(s.reaction(top).x() < 0.97 * peak);
}

TEST_CASE("a rough joint that begins under stress has closed and mobilised what it needs to bear it",
          "[joint_laws][barton_bandis]") {
  const auto element = GENERATE(from_range(elements));
  cdem::Joint joint = loose(rough());
  joint.normal_stiffness = joint.shear_stiffness = 1e11;
  cdem::Simulation s(shear_box(joint, element), 1, nullptr);
  const double shear = 0.8 * pressure * std::tan(rough().friction_angle(pressure, 2e-3));
  cdem::InitialStress field;
  field.stress = {0, 0, -pressure, 0, 0, shear};
  CHECK(s.initial_stress(field).points == 0);
  const cdem::JointSum sum = sum_of(s);
  CHECK(sum.normal == Approx(-pressure));
  CHECK(sum.shear == Approx(shear));
  CHECK(sum.largest_utilisation == Approx(1).epsilon(0.05)); // by steps of 5 % of slip
  field.stress = {0, 0, 0, 0, 0, shear};                     // more than its peak
  CHECK(s.initial_stress(field).points == s.counts().bonds);
}

TEST_CASE("a joint by tables bears and closes as they say", "[joint_laws][joint_table]") {
  const auto element = GENERATE(from_range(elements));
  cdem::JointTable law;
  law.closing = {{0, 0}, {1e-3, 0.5e6}, {1.5e-3, 1.5e6}};
  law.shear = {{0, 1e5}, {2e6, 9e5}};
  cdem::Simulation s(shear_box(loose(law), element), 1, nullptr);
  press(s);
  shear_to(s, 0);
  CHECK(sum_of(s).mean_opening == Approx(-1.25e-3).epsilon(1e-3));
  slide_by(s, 4e-3);
  CHECK(s.reaction(top).x() == Approx(5e5).epsilon(0.01));
}

TEST_CASE("a broken joint keeps its residual cohesion", "[joint_laws]") {
  const auto element = GENERATE(from_range(elements));
  cdem::Joint joint;
  joint.cohesion = 1e6;
  joint.friction_angle = 30 * degree;
  joint.tensile_strength = 0.5e6;
  cdem::ResidualStrength law;
  law.friction = std::tan(20 * degree);
  law.cohesion = 0.2e6;
  joint.law = law;
  cdem::Simulation s(shear_box(joint, element), 1, nullptr);
  press(s);
  shear_to(s, 0);
  shear_to(s, 1e-4);
  CHECK(s.counts().intact == s.counts().bonds);
  slide_by(s, 5e-3);
  CHECK(s.counts().broken_shear == s.counts().bonds);
  double mean = 0; // the blocks vibrate: single moments differ by 1 %
  constexpr int moments = 20;
  for (int i = 0; i < moments; ++i) {
    slide_by(s, 0.1e-3);
    mean += s.reaction(top).x() / moments;
  }
  CHECK(mean == Approx(0.2e6 + pressure * std::tan(20 * degree)).epsilon(0.005));
}

TEST_CASE("the energy balance of sliding joints closes: friction, closure and lifting", "[joint_laws]") {
  const auto element = GENERATE(from_range(elements));
  const int which = GENERATE(0, 1, 2);
  cdem::JointTable table;
  table.closing = {{0, 0}, {1e-3, 0.5e6}, {1.5e-3, 1.5e6}};
  table.shear = {{0, 1e5}, {2e6, 9e5}};
  const cdem::JointLaw law = which == 0   ? cdem::JointLaw(dilating())
                             : which == 1 ? cdem::JointLaw(rough())
                                          : cdem::JointLaw(table);
  CAPTURE(which);
  cdem::Joint joint = loose(law);
  joint.normal_stiffness = joint.shear_stiffness = 5e9; // stiffer joints chatter on coarse blocks
  cdem::Simulation s(shear_box(joint, element), 1, nullptr);
  press(s);
  shear_to(s, 0);
  s.release(top, axes("x"));
  cdem::Fix move = fixed(top, "x");
  move.velocity = Vec3(0.5, 0, 0);
  s.fix(move);
  cdem::RunOptions options;
  options.duration = 0.03;
  options.safety = 0.8;
  s.run(options);
  const cdem::EnergyLedger ledger = s.energy();
  CHECK(ledger.friction > 0.1 * ledger.external_peak);
  CHECK(ledger.balance_error() < 1e-3);
}

TEST_CASE("joint laws give the same bits for every number of threads, and when left and taken up again",
          "[joint_laws]") {
  const auto element = GENERATE(from_range(elements));
  const auto law = GENERATE(cdem::JointLaw(dilating()), cdem::JointLaw(rough()));
  const auto build = [&](int threads, std::shared_ptr<cdem::Observer> observer) {
    cdem::Simulation s(shear_box(loose(law), element), threads, std::move(observer));
    press(s);
    cdem::Fix move = fixed(top, "x");
    move.velocity = Vec3(0.5, 0, 0);
    s.fix(move);
    return s;
  };
  const auto solve = [](cdem::Simulation& s, int done) -> Figures {
    if (done == 0) {
      cdem::Water water;
      water.pressure = [](const Vec3&) { return 0.3e6; };
      s.water(water);
    }
    cdem::RunOptions options;
    options.duration = 0.02;
    const cdem::RunResult r = s.run(options);
    return {double(r.steps), s.energy().friction, s.energy().external};
  };
  check_going_on(build, solve, {1, 20});
}

TEST_CASE("blocks that have parted rub with the friction of the set that held them", "[joint_laws]") {
  // Down an incline of 20 degrees: 10 degrees in the set's law, 40 in the body's.
  const double steepness = 20 * degree, phi = 10 * degree;
  cdem::ModelSpec spec = shear_box(loose({}, phi), cdem::Element::finite_volume);
  spec.bodies[0].joint = loose({}, 40 * degree);
  if (GENERATE(false, true)) { // or by its law
    cdem::ResidualStrength law;
    law.friction = std::tan(phi);
    spec.bodies[0].set_joints["joint"] = loose(law, 15 * degree);
  }
  for (cdem::Joint* joint : {&spec.bodies[0].joint, &spec.bodies[0].set_joints["joint"]})
    joint->normal_stiffness = joint->shear_stiffness = 1e8; // softer than the blocks, that nothing chatters
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::where([](const Vec3& x) { return x.z() < 0.19; }, "the lower block")));
  s.gravity(gravity(9.81 * Vec3(std::sin(steepness), 0, -std::cos(steepness))));
  s.fix(fixed(top, "x"));
  REQUIRE(s.relax({}).converged);
  s.release(top, axes("x"));
  cdem::RunOptions options;
  options.duration = 0.25;
  // It hops by 2e-3 of its size: the interface is left to contact.
  s.initial_velocity(cdem::Selection::of_units("rock", {2}), {0, 0, 0.2}, Vec3::Zero(), {});
  s.run(options);
  REQUIRE(s.joints({{"joint"}, {}}).at(0).parted == 1);
  // Of the centre of mass: m dvx = m g sin t - tan(phi) int N dt,  m dvz = int N dt - m g cos t, so x + tan(phi) z has a
  // constant acceleration through all hops. (A mean velocity of the block would add how it vibrates.)
  const auto place = [&] {
    const Vec3 centre = cdem::units_of(s.model(), s.state(), "rock").at(1).motion(Vec3(0.5, 0.5, 0.225));
    return centre.x() + std::tan(phi) * centre.z();
  };
  options.duration = 0.125;
  const double first = place(), before = s.run(options).time, middle = place();
  const cdem::RunResult run = s.run(options);
  const double half = run.time - before;
  const double a = 9.81 * (std::sin(steepness) - std::tan(phi) * std::cos(steepness));
  CHECK((place() - 2 * middle + first) / (half * half) == Approx(a).epsilon(0.01));
  CHECK(run.time > 0.49);
}

TEST_CASE("laws that do not fit the stiffness of an interface, and laws on meshes, are refused",
          "[joint_laws]") {
  cdem::ModelSpec spec = shear_box(loose(rough()), cdem::Element::finite_volume);
  spec.bodies[0].set_joints["joint"].normal_stiffness = 1e9;
  CHECK_THROWS_WITH(cdem::Simulation(spec, 1, nullptr),
                    Contains("initial_stiffness = 2e+09") && Contains("at most 1e+09 Pa/m"));
  cdem::Bonding bonding;
  bonding.everywhere = true;
  cdem::ModelSpec mesh;
  mesh.bodies = {meshed("unit", geom::box_mesh({1, 1, 1}, {1, 1, 1}), bonding, rock(), loose(dilating()))};
  CHECK_THROWS_WITH(cdem::Simulation(mesh, 1, nullptr), Contains("on the faces of a mesh"));
  cdem::ModelSpec contact;
  contact.bodies = {meshed("unit", geom::box_mesh({1, 1, 1}, {1, 1, 1})),
                    meshed("other", geom::box_mesh({1, 1, 1}, {1, 1, 1}))};
  contact.pairs = {{"unit", "other", loose(dilating())}};
  CHECK_THROWS_WITH(cdem::Simulation(contact, 1, nullptr), Contains("laws of interfaces between blocks"));
}
