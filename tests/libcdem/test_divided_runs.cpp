// A run in several parts, with nothing but looks in between, ends like one run, to the last bit.
#include "libcdem/results/contact_points.hpp"
#include "libgeom/assembly/builders.hpp"
#include "libgeom/assembly/tet_blocks.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"
#include "tests/libcdem/going_on.hpp"

using namespace testing;
using geom::Mat3;
using geom::Vec3;

namespace {

constexpr std::int64_t steps = 330;

enum class Kind { cohesive, springs, blocks, plastic };

cdem::BodySpec falling(Kind kind) {
  cdem::Elastic material = soft_rock();
  material.stiffness_damping = kind == Kind::blocks ? 0 : 2e-6;
  cdem::Joint joint = concrete_joint(cdem::Softening::none);
  joint.tensile_strength = 1.7e5;
  joint.cohesion = 4.4e5;
  if (kind == Kind::blocks) {
    cdem::BodySpec spec =
        body("body", geom::tet_blocks(unstructured({0.4, 0.35, 0.3}, 0.2)), material, joint);
    spec.element = cdem::Element::finite_volume;
    return spec;
  }
  cdem::Bonding bonding = cohesive();
  if (kind == Kind::springs)
    bonding.kind = cdem::BondKind::springs;
  if (kind == Kind::cohesive) {
    joint.softening = cdem::Softening::exponential;
    joint.fracture_energy_1 = 20;
    joint.fracture_energy_2 = 100;
  }
  return meshed("body", unstructured({0.4, 0.35, 0.3}, 0.2),
                kind == Kind::plastic ? cdem::Bonding{} : bonding, material, joint);
}

// A body that falls on a rigid floor, in a flow from the side, and breaks.
cdem::Simulation in_flow(Kind kind, int threads = 1, std::shared_ptr<cdem::Observer> observer = nullptr) {
  cdem::ModelSpec spec;
  spec.bodies = {
      meshed("floor", box_at({3, 3, 0.2}, {2, 2, 1}, Mat3::Identity(), {0, 0, -0.101}), {}, soft_rock()),
      falling(kind)};
  spec.bodies[0].element = cdem::Element::rigid;
  cdem::Joint rubbing = friction(30);
  rubbing.restitution = 0.5;
  spec.pairs = {{"floor", "body", rubbing}};
  if (kind != Kind::blocks)
    spec.pairs.push_back({"body", "body", rubbing});
  cdem::Simulation s(spec, threads, std::move(observer));
  s.fix(fixed(body_of("floor")));
  s.gravity(gravity());
  cdem::Flow flow;
  flow.on = {body_of("body")};
  flow.direction = {1, 0.2, 0};
  flow.velocity = [](double) { return 8; };
  flow.relative = kind != Kind::springs;
  s.flow(flow);
  s.initial_velocity(body_of("body"), {1, 0.2, -6}, {0, 2, 1});
  return s;
}

void run(cdem::Simulation& s, std::int64_t count) {
  cdem::RunOptions options;
  options.steps = count;
  s.run(options);
}

void check_same_end(const cdem::Simulation& a, const cdem::Simulation& b) {
  CHECK(a.state_hash() == b.state_hash());
  CHECK(a.time() == b.time());
  CHECK(a.energy().total() == b.energy().total());
  REQUIRE(a.log().breaks.size() == b.log().breaks.size());
  for (std::size_t i = 0; i < a.log().breaks.size(); ++i)
    CHECK((a.log().breaks[i].place == b.log().breaks[i].place &&
           a.log().breaks[i].time == b.log().breaks[i].time));
}

} // namespace

TEST_CASE("divided runs: two runs end like one", "[run][contact][breaking]") {
  const Kind kind = GENERATE(Kind::cohesive, Kind::springs, Kind::blocks, Kind::plastic);
  cdem::Simulation whole = in_flow(kind);
  run(whole, steps);
  if (kind != Kind::plastic)
    CHECK(whole.log().breaks.size() > 30);
  for (const std::int64_t first : {77, 213}) {
    INFO("kind " << static_cast<int>(kind) << ", divided after " << first);
    cdem::Simulation divided = in_flow(kind);
    run(divided, first);
    cdem::contact_points(divided.model(), divided.state());
    divided.reset_displacement(); // of results only
    run(divided, steps - first);
    check_same_end(divided, whole);
  }
}

TEST_CASE("divided runs: a state that is saved between two runs, and a copy, go on alike",
          "[run][checkpoint]") {
  cdem::Simulation whole = in_flow(Kind::cohesive);
  run(whole, steps);
  cdem::Simulation first = in_flow(Kind::cohesive), restored = in_flow(Kind::cohesive),
                   loaded = in_flow(Kind::cohesive);
  run(first, 177);
  restored.restore(first.save());
  loaded.restore_state(first.save());
  cdem::Simulation copy = first.copy();
  for (cdem::Simulation* s : {&first, &restored, &loaded, &copy}) {
    run(*s, steps - 177);
    CHECK(s->state_hash() == whole.state_hash());
  }
  check_same_end(restored, whole);
}

TEST_CASE("divided runs: a second run that was left goes on", "[run][checkpoint]") {
  const auto build = [](int threads, std::shared_ptr<cdem::Observer> observer) {
    return in_flow(Kind::cohesive, threads, std::move(observer));
  };
  const auto solve = [](cdem::Simulation& s, int done) {
    if (done == 0)
      run(s, 177);
    run(s, steps - 177);
    return Figures{s.time()};
  };
  check_going_on(build, solve, {3, 13});
}

TEST_CASE("divided runs: what is changed between two runs counts", "[run]") {
  cdem::Simulation s = in_flow(Kind::cohesive), other = in_flow(Kind::cohesive);
  for (cdem::Simulation* each : {&s, &other})
    run(*each, 100);
  s.initial_velocity(body_of("body"), {0, 0, 3});
  run(s, 1);
  run(other, 1);
  CHECK(s.mean("velocity.z", body_of("body")) == Approx(3).margin(0.5));
  CHECK(s.state_hash() != other.state_hash());
}

TEST_CASE("divided runs: a call in between that is refused changes nothing", "[run]") {
  cdem::Simulation whole = in_flow(Kind::cohesive), divided = in_flow(Kind::cohesive);
  run(whole, steps);
  run(divided, 177);
  const std::uint64_t hash = divided.state_hash();
  cdem::RunOptions too_long;
  too_long.steps = 10;
  too_long.time_step = 1;
  CHECK_THROWS_AS(divided.run(too_long), geom::InputError);
  CHECK(divided.state_hash() == hash);
  run(divided, steps - 177);
  check_same_end(divided, whole);
}
