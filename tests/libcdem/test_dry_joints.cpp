// Dry joints at the usual step: the rattle of few steps dies out (bond/contact_damping.hpp), so masonry keeps its energy and
// a block slides on a joint by Coulomb's law.
#include "tests/libcdem/boxes.hpp"
#include "tests/libcdem/going_on.hpp"

#include "libcdem/bond/contact_damping.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"

#include <cmath>

using namespace testing;
using geom::Vec3;

namespace {

constexpr double g = 9.81;

// A rigid cube of 1 m that was built flush on a rigid plane, as a whole turned by `turn`; gravity acts as on a slope.
struct FlushBlock {
  geom::Mat3 turn;
  cdem::Simulation s;
  double slope;

  FlushBlock(double steep, const geom::Mat3& turned)
      : turn(turned), s(spec(turned), 1, nullptr), slope(steep) {
    s.fix(fixed(cdem::Selection::of_body("plane")));
    cdem::Gravity gravity;
    gravity.acceleration = turn * Vec3(g * std::sin(slope), 0, -g * std::cos(slope));
    s.gravity(gravity);
  }
  double slid() const { // m
    const cdem::Selection block = cdem::Selection::of_body("block");
    return turn.col(0).dot(Vec3(s.mean("displacement.x", block), s.mean("displacement.y", block),
                                s.mean("displacement.z", block)));
  }

private:
  static cdem::ModelSpec spec(const geom::Mat3& turn) {
    const Eigen::AngleAxisd by(turn);
    const auto turned = [&](const geom::Assembly& shape) {
      return geom::rotated(shape, by.axis(), by.angle());
    };
    cdem::ModelSpec spec;
    spec.bodies = {
        body("plane", turned(geom::grid({4, 2, 0.2}, {1, 1, 1}, {-1, -1, -0.2})), rock(), friction(30)),
        body("block", turned(geom::grid({1, 1, 1}, {1, 1, 1}, {-0.5, -0.5, 0})), rock(), friction(30))};
    for (cdem::BodySpec& of : spec.bodies)
      of.element = cdem::Element::rigid;
    spec.pairs = {{"plane", "block", friction(30)}};
    return spec;
  }
};

cdem::RunOptions for_time(double duration, double safety = 0.9) {
  cdem::RunOptions options;
  options.duration = duration;
  options.safety = safety;
  return options;
}

} // namespace

TEST_CASE(
    "dry joints: a rigid block built flush on a plane stays below the friction angle and slides above it",
    "[dry_joints]") {
  const geom::Mat3 turn = GENERATE(geom::Mat3(geom::Mat3::Identity()), rotation({1, 2, -0.5}, 37 * degree));
  const double time = 0.3;
  {
    FlushBlock block(29 * degree, turn);
    block.s.run(for_time(time));
    CHECK(std::abs(block.slid()) < 1e-4);
  }
  FlushBlock block(31 * degree, turn);
  block.s.run(for_time(time));
  const double a = g * (std::sin(block.slope) - std::tan(30 * degree) * std::cos(block.slope));
  CHECK(block.slid() == Approx(0.5 * a * time * time).epsilon(0.05));
  CHECK(block.s.energy().balance_error() < 1e-3);
}

TEST_CASE("dry joints: a wall without mortar keeps its energy at the usual step", "[dry_joints][energy]") {
  cdem::Elastic stone = rock();
  stone.youngs_modulus = 1e10;
  geom::BrickOptions bricks;
  bricks.size = {2, 0.25, 2};
  bricks.brick = {0.5, 0.25, 0.25};
  cdem::ModelSpec spec;
  spec.bodies = {body("wall", geom::bricks(bricks), stone, friction(35)),
                 body("ground", geom::grid({4, 2, 0.5}, {1, 1, 1}, {-1, -0.875, -0.5}), stone, friction(35))};
  spec.bodies[0].element = cdem::Element::finite_volume;
  spec.bodies[1].element = cdem::Element::rigid;
  spec.pairs = {{"wall", "ground", friction(35)}};
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::of_body("ground")));
  cdem::Gravity gravity;
  gravity.acceleration = Vec3(0, 0, -g);
  s.gravity(gravity);
  s.run(for_time(0.04));
  CHECK(s.energy().balance_error() < 0.01);
}

TEST_CASE("dry joints: their damping leaves the step stable", "[dry_joints]") {
  for (const double s : {0.1, 0.5, 0.9, 0.97, 1.0}) {
    const double step = 1e-5, beta = cdem::contact_damping(step, step / s);
    CAPTURE(s);
    CHECK(beta >= 0);
    CHECK(s * s * (1 + 2 * beta / step) <= 1 + 1e-12); // dt^2 K / 4 + beta dt K / 2 over M
  }
  // At all steps up to the stable one the same dashpot.
  const double stable = cdem::stable_step_of_dry_joints(1);
  CHECK(cdem::contact_damping(0.01, 1) == cdem::contact_damping(0.9 * stable, 1));
  CHECK(stable * stable / 4 + cdem::contact_damping(0.9 * stable, 1) * stable / 2 == Approx(0.25));
}

TEST_CASE("dry joints: a grid of blocks stands under its weight at the usual step", "[dry_joints][energy]") {
  cdem::Elastic stone = rock();
  stone.youngs_modulus = 5e9;
  cdem::ModelSpec spec;
  spec.bodies = {body("grid", geom::grid({0.6, 0.4, 0.3}, {3, 2, 2}, {0, 0, 0}), stone, friction(30))};
  spec.bodies[0].element = cdem::Element::finite_volume;
  cdem::Simulation s(spec, 1, nullptr);
  s.fix(fixed(cdem::Selection::side("z-")));
  cdem::Gravity gravity;
  gravity.acceleration = Vec3(0, 0, -g);
  s.gravity(gravity);
  s.run(for_time(0.03));
  CHECK(s.energy().kinetic < s.energy().external);
  CHECK(s.energy().balance_error() < 0.03);
}

namespace {

// A deformable block that lies flush on a rigid plate, without any damping.
cdem::ModelSpec on_plate(const Vec3& size, double zone_size, double friction_angle, double youngs_modulus) {
  cdem::Elastic stone = rock();
  stone.youngs_modulus = youngs_modulus;
  cdem::ModelSpec spec;
  spec.bodies = {
      body("plate", geom::grid({4, 4, 0.4}, {1, 1, 1}, {-2, -2, -0.4}), stone, friction(friction_angle)),
      body("block", geom::grid(size, {1, 1, 1}, {-0.5 * size.x(), -0.5 * size.y(), 0}), stone,
           friction(friction_angle))};
  spec.bodies[0].element = cdem::Element::rigid;
  spec.bodies[1].element = cdem::Element::finite_volume;
  spec.bodies[1].zone_size = zone_size;
  spec.pairs = {{"plate", "block", friction(friction_angle)}};
  return spec;
}

void set_gravity(cdem::Simulation& s, const Vec3& acceleration) {
  cdem::Gravity gravity;
  gravity.acceleration = acceleration;
  s.gravity(gravity);
}

// `part` of the friction pulls after 0.2 s.
void pull(cdem::Simulation& s, double part, double friction_angle) {
  for (int i = 0; i <= 20; ++i) {
    set_gravity(s, {part * std::tan(friction_angle * degree) * g * i / 20, 0, -g});
    s.run(for_time(0.01));
  }
}

const cdem::Selection block = cdem::Selection::of_body("block");

} // namespace

TEST_CASE("dry joints: below its friction a deformable block that is pulled does not creep, above it slides",
          "[dry_joints]") {
  const double part = GENERATE(0.9, 0.99, 1.01);
  const bool relaxed = GENERATE(false, true);
  CAPTURE(part, relaxed);
  cdem::Simulation s(on_plate({1, 0.8, 0.2}, 0, 31, 1e9), 1, nullptr);
  s.fix(fixed(cdem::Selection::of_body("plate")));
  set_gravity(s, {0, 0, -g}); // at once, unless a relaxation follows
  if (relaxed)
    s.relax({});
  const double holds = part < 1 ? 0.3 : 0.5; // s
  pull(s, part, 31);
  s.run(for_time(holds));
  if (part < 1)
    CHECK(std::abs(s.mean("displacement.x", block)) < 2.5e-6);
  else // the last hundredth of a second of the pull is above the friction
    CHECK(s.mean("velocity.x", block) ==
          Approx(0.01 * std::tan(31 * degree) * g * (holds + 0.01)).epsilon(0.02));
  CHECK(s.energy().balance_error() < 1e-3);
}

// Without dashpots bars of small strain doubled their energy.
TEST_CASE("dry joints: a bar that is torn and driven together again keeps its energy",
          "[dry_joints][energy]") {
  const cdem::Element element = GENERATE(cdem::Element::small_strain, cdem::Element::finite_volume);
  const double safety = GENERATE(0.9, 0.5);
  CAPTURE(static_cast<int>(element), safety);
  cdem::Elastic stone = rock();
  stone.youngs_modulus = 3e10;
  cdem::Joint bonded = friction(30);
  bonded.bonded = true;
  bonded.cohesion = 8e6;
  bonded.tensile_strength = 3e6;
  cdem::ModelSpec spec;
  spec.bodies = {body("bar", geom::grid({1.2, 0.1, 0.1}, {12, 2, 2}, {0, 0, 0}), stone, bonded)};
  spec.bodies[0].element = element;
  cdem::Simulation s(spec, 1, nullptr);
  const auto drive = [&](double speed) {
    for (const double way : {-1, 1}) {
      cdem::Fix lead = fixed(cdem::Selection::side(way < 0 ? "x-" : "x+"), "x");
      lead.velocity = Vec3(way * speed, 0, 0);
      s.fix(lead);
    }
  };
  drive(1);
  s.run(for_time(3e-4, safety));
  REQUIRE(s.log().broken_tension > 30);
  drive(-0.5);
  s.run(for_time(6e-4, safety));
  s.release(cdem::Selection::side("x-"), {true, true, true});
  s.release(cdem::Selection::side("x+"), {true, true, true});
  s.run(for_time(2e-3, safety));
  CHECK(s.energy().balance_error() < (safety > 0.5 ? 0.07 : 0.02));
}

// Friction that follows each vibration of the normal force lets them slide up to 1.4 times as fast.
TEST_CASE("dry joints: a deformable plate slides down a slope as its friction says", "[dry_joints]") {
  const double friction_angle = GENERATE(20, 30, 40), slope = (friction_angle + 3) * degree,
               zone_size = GENERATE(0, 0.25);
  CAPTURE(friction_angle, zone_size);
  cdem::Simulation s(on_plate({1, 1, 0.25}, zone_size, friction_angle, 1e10), 1, nullptr);
  s.fix(fixed(cdem::Selection::of_body("plate")));
  set_gravity(s, {g * std::sin(slope), 0, -g * std::cos(slope)});
  cdem::RelaxOptions relaxation;
  relaxation.max_steps = 1000; // it never comes to rest
  s.relax(relaxation);
  s.run(for_time(0.05));
  const double before = s.mean("velocity.x", block);
  s.run(for_time(0.05));
  CHECK((s.mean("velocity.x", block) - before) / 0.05 ==
        Approx(g * (std::sin(slope) - std::tan(friction_angle * degree) * std::cos(slope))).epsilon(2e-3));
}

TEST_CASE("dry joints: a block that is left as it slides goes on to the same bits",
          "[dry_joints][checkpoint]") {
  check_going_on(
      [](int threads, const std::shared_ptr<cdem::Observer>& observer) {
        cdem::Simulation s(on_plate({1, 1, 0.25}, 0.25, 30, 1e9), threads, observer);
        s.fix(fixed(cdem::Selection::of_body("plate")));
        set_gravity(s, {0.6 * g, 0, -g});
        return s;
      },
      [](cdem::Simulation& s, std::int64_t done) {
        if (done < 1)
          s.run(for_time(0.05));
        return Figures{s.mean("displacement.x", block)};
      },
      {15, 40});
}
