// Joints between convex blocks that move far, when one face slides a long way past the other: the joint goes on pressing,
// rubbing and riding up as its law says, because its springs follow the faces.
#include "tests/libcdem/boxes.hpp"
#include "tests/libcdem/going_on.hpp"

#include "libcdem/fracture/interface_memory.hpp"
#include "libcdem/results/one_way_energies.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/edit.hpp"

using namespace testing;
using geom::Vec3;

namespace {

constexpr double kn = 1e9; // Pa/m

cdem::Joint pressed_joint(double angle = 30) {
  cdem::Joint joint = friction(angle);
  joint.normal_stiffness = joint.shear_stiffness = kn;
  return joint;
}

// A cube of 1 m on a floor, both turned about the origin as a whole.
struct ShearBox {
  geom::Mat3 turn;
  cdem::Simulation s;
  cdem::Selection top, bottom;

  ShearBox(const cdem::Joint& joint, const geom::Mat3& turned, double viscosity = 0, double zones = 0,
           int threads = 1, const Vec3& floor = {3, 3, 1}, double height = 1,
           std::shared_ptr<cdem::Observer> observer = nullptr)
      : turn(turned), s(spec(joint, turned, viscosity, zones, floor, height), threads, std::move(observer)),
        top(level(height - 1e-3, height + 1e-3)), bottom(level(-1.001, -0.999)) {
    s.fix(fixed(bottom));
  }

  Vec3 axis(int i) const { return turn.col(i); }
  double along(int i, const Vec3& v) const { return v.dot(turn.col(i)); }
  double moved(int i) const { // m, mean of the top
    return along(
        i, {s.mean("displacement.x", top), s.mean("displacement.y", top), s.mean("displacement.z", top)});
  }
  void move_top(const Vec3& velocity) {
    cdem::Fix move = fixed(top);
    move.velocity = Vec3(turn * velocity);
    s.fix(move);
  }

private:
  cdem::Selection level(double low, double high) const {
    const Vec3 up = turn.col(2);
    return cdem::Selection::where([=](const Vec3& x) { return x.dot(up) > low && x.dot(up) < high; },
                                  "a level");
  }
  static cdem::ModelSpec spec(const cdem::Joint& joint, const geom::Mat3& turn, double viscosity,
                              double zones, const Vec3& floor, double height) {
    cdem::Elastic soft = rock();
    soft.youngs_modulus = 1e10;
    soft.poissons_ratio = 0;
    soft.viscosity = viscosity;
    const Eigen::AngleAxisd by(turn);
    const auto turned = [&](const geom::Assembly& shape) {
      return geom::rotated(shape, by.axis(), by.angle());
    };
    cdem::ModelSpec spec;
    spec.bodies = {body("floor", turned(geom::grid(floor, {1, 1, 1}, {-1.1, -1.2, -1})), soft, joint),
                   body("block", turned(geom::grid({1, 1, height}, {1, 1, 1})), soft, joint)};
    for (cdem::BodySpec& of : spec.bodies) {
      of.element = cdem::Element::finite_volume;
      of.zone_size = zones;
    }
    spec.pairs = {{"floor", "block", joint}};
    return spec;
  }
};

const geom::Mat3 straight = geom::Mat3::Identity(), odd = rotation({1, 2, -0.5}, 37 * degree);

cdem::RunOptions lasting(double duration, double local_damping = 0) {
  cdem::RunOptions options;
  options.duration = duration;
  options.local_damping = local_damping;
  return options;
}

void relax(cdem::Simulation& s) {
  cdem::RelaxOptions options;
  options.residual = 1e-6;
  REQUIRE(s.relax(options).converged);
}

cdem::Joint dilating(double angle = 10) {
  cdem::ResidualStrength law;
  law.friction = std::tan(25 * degree);
  law.dilation = std::tan(angle * degree);
  cdem::Joint joint = pressed_joint();
  joint.law = law;
  return joint;
}

} // namespace

TEST_CASE("sliding blocks: at a constant normal displacement a joint keeps its normal force and its friction",
          "[sliding]") {
  const auto [turn, zones] = GENERATE(std::pair(straight, 0.0), std::pair(odd, 0.0), std::pair(odd, 0.4));
  ShearBox box(pressed_joint(), turn, 2e5, zones);
  cdem::Fix press = fixed(box.top);
  press.displacement = Vec3(turn * Vec3(0, 0, -1e-3));
  box.s.fix(press);
  relax(box.s);
  const double pressed = -box.along(2, box.s.reaction(box.top));
  CHECK(pressed > 0.8 * kn * 1e-3);
  box.move_top({0.2, 0, 0});
  for (int i = 0; i < 6; ++i) { // to 0.3 m
    box.s.run(lasting(0.25));
    CAPTURE(zones, i, box.moved(0));
    const Vec3 reaction = box.s.reaction(box.bottom); // the floor stands still: no viscous drag
    CHECK(box.along(2, reaction) == Approx(pressed).epsilon(0.03));
    CHECK(-box.along(0, reaction) == Approx(pressed * std::tan(30 * degree)).epsilon(0.03));
    CHECK(box.s.energy().balance_error() < 1e-3);
  }
  CHECK(box.s.joints({}).at(0).parted == 0);
  CHECK(box.s.joints({}).at(0).mean_slip == Approx(0.3).epsilon(0.01));
}

TEST_CASE(
    "sliding blocks: each bond that broke stands once among the breaks, whatever springs the faces have now",
    "[sliding]") {
  cdem::Joint joint = pressed_joint();
  joint.bonded = true;
  joint.cohesion = joint.tensile_strength = 1e5;
  ShearBox box(joint, odd, 2e5);
  const cdem::ModelCounts before = box.s.counts();
  CHECK(before.intact == before.bonds);
  box.move_top({0.4, 0.2, 0});
  std::int64_t broken = 0;
  bool other_springs = false;
  for (int i = 0; i < 8; ++i) {
    const cdem::RunResult ran = box.s.run(lasting(0.25));
    const cdem::ModelCounts now = box.s.counts();
    CHECK(now.broken_tension + now.broken_shear == now.bonds);
    broken += ran.broken_tension + ran.broken_shear;
    other_springs = other_springs || now.bonds != before.bonds;
  }
  CHECK(other_springs);
  CHECK(broken == before.bonds);
  CHECK(static_cast<std::int64_t>(box.s.log().breaks.size()) == before.bonds);
}

TEST_CASE("sliding blocks: under a constant pressure a block does not sink", "[sliding]") {
  const geom::Mat3 turn = GENERATE(straight, odd);
  const double pressure = 1e6, closure = pressure / kn;
  ShearBox box(pressed_joint(1), turn);
  box.s.traction(traction(box.top, turn * Vec3(0, 0, -pressure)));
  relax(box.s);
  const double height = box.moved(2);
  CHECK(height < -closure);
  box.s.initial_velocity(cdem::Selection::of_body("block"), turn * Vec3(2, 0, 0), Vec3::Zero(), {});
  box.s.run(lasting(0.3, 0.02));
  CHECK(box.moved(0) > 0.2);
  CHECK(box.moved(2) == Approx(height).margin(0.1 * closure));
}

// The block is pushed at its whole speed at once, and vibrates: its mean force is that of the law, as the work of the push tells.
TEST_CASE("sliding blocks: a pressed joint with dilation follows its law", "[sliding][joint_laws]") {
  const double pressure = 1e6, angle = GENERATE(10.0, 24.9);
  ShearBox box(dilating(angle), straight, 0, 0, 1, {3, 3, 1}, 0.2); // flat: all of its joint stays pressed
  box.s.traction(traction(box.top, {0, 0, -pressure}));
  box.s.fix(fixed(box.top, "xy"));
  relax(box.s);
  const double height = box.moved(2);
  box.s.release(box.top, axes("x"));
  cdem::Fix move = fixed(box.top, "x");
  move.velocity = Vec3(0.1, 0, 0);
  box.s.fix(move);
  box.s.run(lasting(0.1));      // it slides everywhere
  for (int i = 0; i < 4; ++i) { // to 0.2 m
    const double slid_before = box.moved(0), rise_before = box.moved(2),
                 given_before = box.s.energy().external;
    box.s.run(lasting(0.5));
    const double slid = box.moved(0);
    CAPTURE(angle, slid);
    CHECK(box.moved(2) - height == Approx(slid * std::tan(angle * degree)).epsilon(0.03));
    const double work =
        box.s.energy().external - given_before + pressure * (box.moved(2) - rise_before); // J, of the push
    CHECK(work / (slid - slid_before) == Approx(pressure * std::tan(25 * degree)).epsilon(0.003));
    CHECK(box.s.energy().balance_error() < 1e-3);
    CHECK(cdem::impossible_energy(box.s.energy(), box.s.time(), box.s.log().one_way).part < 1e-4);
  }
  CHECK(box.s.joints({}).at(0).parted == 0);
}

TEST_CASE("sliding blocks: on a slope a joint rides up under the weight of its block, as far as its law says",
          "[sliding][joint_laws]") {
  const auto [turn, height] =
      GENERATE(std::pair(straight, 0.2), std::pair(straight, 1.0), std::pair(odd, 1.0));
  const double steep = 30 * degree, limit = 0.1;
  cdem::Joint joint = dilating();
  std::get<cdem::ResidualStrength>(joint.law).dilation_limit = limit;
  ShearBox box(joint, turn, 0, 0, 1, {3, 3, 1}, height);
  box.s.gravity(gravity(9.81 * (turn * Vec3(std::sin(steep), 0, -std::cos(steep)))));
  // Where the dilation ends, the block goes on upwards at its speed, 0.06 m/s: it hops by tenths of a millimetre and lands
  // again. So its height is that of the law as a mean over 0.1 s.
  constexpr int moments = 5;
  for (int i = 0; i < 8; ++i) {
    double above = 0; // m, mean
    for (int k = 0; k < moments; ++k) {
      box.s.run(
          lasting(0.1 / moments, height < 1 ? 0 : 0.3)); // a tall one rocks, as its weight comes all at once
      above += (box.moved(2) - std::min(box.moved(0), limit) * std::tan(10 * degree)) / moments;
    }
    CAPTURE(height, i, box.moved(0), box.moved(2));
    CHECK(std::abs(above) < 0.03 * limit * std::tan(10 * degree));
    CHECK(box.s.energy().balance_error() < 0.01);
  }
  CHECK(box.s.joints({}).at(0).parted == 0);
}

TEST_CASE("sliding blocks: a block that spins on its joint by more than a right angle stays on it",
          "[sliding]") {
  ShearBox box(pressed_joint(0), odd);
  box.s.gravity(gravity(odd * Vec3(0, 0, -9.81)));
  relax(box.s);
  const double height = box.moved(2);
  box.s.initial_velocity(cdem::Selection::of_body("block"), Vec3::Zero(), odd * Vec3(0, 0, 3), {});
  box.s.run(lasting(0.7));
  CHECK(box.moved(2) == Approx(height).margin(2e-5));
  CHECK(box.s.joints({}).at(0).parted == 0);
  CHECK(box.s.energy().balance_error() < 1e-3);
}

TEST_CASE("sliding blocks: what new springs take up lies within what the old ones have", "[sliding]") {
  const auto model_of = [](double shift, double across) {
    const cdem::Joint joint = pressed_joint();
    cdem::ModelSpec spec;
    spec.bodies = {body("floor", geom::grid({1.1, 1.3, 1}, {1, 1, 1}), rock(), joint),
                   body("block", geom::grid({1, 1, 1}, {1, 1, 1}, {shift, across, 1}), rock(), joint)};
    spec.pairs = {{"floor", "block", joint}};
    return cdem::Simulation(spec, 1, nullptr);
  };
  const cdem::Simulation before = model_of(0.05, 0.05);
  const cdem::Model& model = before.model();
  cdem::State state = before.state();
  const double pressure = 1e5 / 3, damage = 0.1 + 0.2; // Pa
  state.rested.assign(state.rested.size(), 1);
  state.bond_damage.assign(state.rested.size(), damage);
  state.bond_slip.resize(state.rested.size());
  for (std::size_t p = 0; p < state.usual_force.size(); ++p)
    state.usual_force[p] = pressure * model.points[p].area;
  REQUIRE(model.interfaces.size() == 1);
  const cdem::InterfaceMemory memory(model, state, model.interfaces[0]);
  int springs = 0;
  for (int i = 0; i < 30; ++i) {
    const cdem::Simulation after = model_of(0.05 + 0.017 * i, 0.05 + 0.013 * i);
    for (std::size_t p = 0; p < after.model().points.size(); ++p, ++springs) {
      const cdem::SpringMemory m = memory.at(after.model(), static_cast<int>(p));
      CHECK(m.rested == 1);
      CHECK(m.damage == damage);
      CHECK(m.usual == Approx(pressure).epsilon(1e-14));
    }
  }
  CHECK(springs > 100);
}

TEST_CASE("sliding blocks: a face that slides over the end of the other is left to contact once they overlap "
          "no more",
          "[sliding]") {
  ShearBox box(pressed_joint(0), straight, 0, 0, 1, {2.2, 3, 1});
  box.move_top({1, 0, 0});
  box.s.run(lasting(1));
  const double area = box.s.joints({}).at(0).area; // of 0.1 m2, up to 0.02 m behind
  CHECK(area > 0.099);
  CHECK(area < 0.121);
  box.s.run(lasting(0.2));
  CHECK(box.s.joints({}).at(0).parted == 1);
}

TEST_CASE("sliding blocks end in the same bits for every number of threads, and when left and taken up again",
          "[sliding][threads]") {
  const auto law = GENERATE(0, 1);
  const auto build = [&](int threads, std::shared_ptr<cdem::Observer> observer) {
    ShearBox box(law == 0 ? pressed_joint() : dilating(), odd, 0, 0, threads, {3, 3, 1}, 1,
                 std::move(observer));
    cdem::Fix press = fixed(box.top);
    press.displacement = Vec3(odd * Vec3(0, 0, -1e-3));
    box.s.fix(press);
    box.move_top({3, 0, 0.5});
    return std::move(box.s);
  };
  const auto solve = [](cdem::Simulation& s, int) -> Figures {
    const cdem::RunResult r = s.run(lasting(0.05));
    return {double(r.steps), s.energy().friction, s.energy().external};
  };
  check_going_on(build, solve, {1, 8, 20});
}
